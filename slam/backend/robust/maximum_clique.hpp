// A largest set of nodes of which every two are joined.
// First the heuristic of [Pattabiraman2013] (algorithm 2): from every node, the neighbour of
// highest degree that is joined to all chosen so far; O(n^3 / 64) at worst. Then branch and bound
// with greedy colouring as the bound [Tomita2003], on rows of bits [SanSegundo2011], which ends
// with the proof that nothing larger exists, or after max_branches with the best that was found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace corridor::backend {

// An undirected graph as rows of bits: n^2 / 8 bytes.
class BitGraph {
 public:
  explicit BitGraph(std::size_t num_nodes)
      : num_nodes_(num_nodes),
        num_words_((num_nodes + kWordBits - 1) / kWordBits),
        rows_(num_nodes * num_words_, 0) {}

  // Requires a != b.
  void join(std::size_t a, std::size_t b) {
    set(a, b);
    set(b, a);
  }
  [[nodiscard]] bool are_joined(std::size_t a, std::size_t b) const {
    return (row(a)[b / kWordBits] >> (b % kWordBits)) & 1u;
  }
  [[nodiscard]] std::size_t num_nodes() const { return num_nodes_; }
  [[nodiscard]] std::size_t num_words() const { return num_words_; }
  [[nodiscard]] const std::uint64_t* row(std::size_t node) const {
    return &rows_[node * num_words_];
  }

  static constexpr std::size_t kWordBits = 64;

 private:
  void set(std::size_t a, std::size_t b) {
    rows_[a * num_words_ + b / kWordBits] |= std::uint64_t{1} << (b % kWordBits);
  }

  std::size_t num_nodes_, num_words_;
  std::vector<std::uint64_t> rows_;
};

struct Clique {
  std::vector<std::size_t> nodes;  // ascending
  bool is_proven = false;          // no larger one exists
};

Clique maximum_clique(const BitGraph& graph, std::int64_t max_branches);

}  // namespace corridor::backend
