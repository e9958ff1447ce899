// The loop closures in the graph: adds them and takes out those that the rest of the graph
// contradicts once everything is solved.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "slam/backend/back_end.hpp"
#include "slam/fusion/loop_closer.hpp"

namespace corridor::fusion {

class LoopEdges {
 public:
  // gate: chi-square of one closure after solving beyond which it counts as false.
  explicit LoopEdges(double gate) : gate_(gate) {}

  struct Outcome {
    bool is_any_kept = false;                    // of the closures given
    std::vector<backend::BackEndReport> solves;  // in order; empty: nothing was added
  };

  // Adds the closures of key scans that have none yet and solves. Then, while one of all closures
  // is beyond the gate, takes out the worst and solves again: a false closure bends the graph and
  // puts true ones beyond the gate too, which come back when it is gone.
  Outcome add(std::span<const LoopClosure> closures, backend::BackEnd& back_end);

  [[nodiscard]] int num_added() const { return num_added_; }
  [[nodiscard]] int num_removed() const { return num_removed_; }

 private:
  void remove_false_ones(backend::BackEnd& back_end, Outcome& outcome);

  double gate_;
  std::set<std::uint32_t> closed_keys_;
  std::vector<graph::FactorId> ids_;  // of those in the graph
  int num_added_ = 0, num_removed_ = 0;
};

}  // namespace corridor::fusion
