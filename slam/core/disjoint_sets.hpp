// Which of the numbers 0 ... n - 1 are joined, directly or through others: union-find with path
// halving [Tarjan1984].
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace corridor {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t num_members) : parents_(num_members), num_sets_(num_members) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }

  void join(std::size_t a, std::size_t b) {
    const std::size_t root_a = root_of(a), root_b = root_of(b);
    if (root_a == root_b) return;
    parents_[root_a] = root_b;
    --num_sets_;
  }
  // The same for all members of a set, until the next join().
  [[nodiscard]] std::size_t root_of(std::size_t member) {
    while (parents_[member] != member) member = parents_[member] = parents_[parents_[member]];
    return member;
  }
  [[nodiscard]] std::size_t num_sets() const { return num_sets_; }

 private:
  std::vector<std::size_t> parents_;
  std::size_t num_sets_;
};

}  // namespace corridor
