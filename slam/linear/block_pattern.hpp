// Which variables share a nonzero block of a symmetric matrix.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace corridor::linear {

constexpr std::size_t to_index(std::ptrdiff_t value) { return static_cast<std::size_t>(value); }

// The variables of higher number that variable j shares a block with are
// rows[starts[j]] ... rows[starts[j + 1] - 1], each once. The diagonal is not listed.
struct BlockPattern {
  std::vector<int> starts = {0};
  std::vector<int> rows;

  [[nodiscard]] int num_variables() const { return static_cast<int>(starts.size()) - 1; }
  [[nodiscard]] std::span<const int> of(int variable) const {
    const std::size_t j = to_index(variable);
    return std::span(rows).subspan(to_index(starts[j]), to_index(starts[j + 1] - starts[j]));
  }
  bool operator==(const BlockPattern&) const = default;
};

}  // namespace corridor::linear
