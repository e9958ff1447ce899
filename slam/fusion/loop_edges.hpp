// The loop closures in the graph: adds them and takes out those that the rest of the graph
// contradicts once everything is solved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "slam/backend/back_end.hpp"
#include "slam/fusion/loop_closer.hpp"

namespace corridor::fusion {

class LoopEdges {
 public:
  explicit LoopEdges(const FusionParams& params) : params_(params) {}

  using Outcome =
      std::vector<backend::BackEndReport>;  // of the solves, in order; empty: none added

  // Adds the closures of key scans that have none and solves. Then, while one of all closures is
  // beyond the gate and not firm, takes out the worst and solves again: a false
  // closure bends the graph and puts true ones beyond the gate too, which come back when it is
  // gone.
  Outcome add(std::span<const LoopClosure> closures, backend::BackEnd& back_end);

  [[nodiscard]] std::size_t num_in_graph() const { return edges_.size(); }
  [[nodiscard]] int num_removed() const { return num_removed_; }
  // Path at which the newest closure in the graph was found; 0 without one.
  [[nodiscard]] double last_path_m() const;

 private:
  struct Edge {
    graph::FactorId id;
    std::uint32_t scan_key;
    double path_m;
    bool is_firm;
  };
  void remove_false_ones(backend::BackEnd& back_end, Outcome& solves);

  const FusionParams& params_;
  std::vector<Edge> edges_;  // those in the graph, in the order in which they came
  int num_removed_ = 0;
};

}  // namespace corridor::fusion
