// Numbers variables 0, 1, 2 ... in the order in which they arrive: the rows of a linear system.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "slam/core/expect.hpp"
#include "slam/graph/key.hpp"

namespace corridor::graph {

class VariableIndex {
 public:
  // Returns its number. Requires !contains(key).
  int add(Key key) {
    CORRIDOR_EXPECT(!contains(key));
    auto& numbers = numbers_[kind_of(key)];
    if (key.index >= numbers.size()) numbers.resize(key.index + 1, kNone);
    numbers[key.index] = static_cast<int>(keys_.size());
    keys_.push_back(key);
    return numbers[key.index];
  }
  [[nodiscard]] bool contains(Key key) const {
    const auto& numbers = numbers_[kind_of(key)];
    return key.index < numbers.size() && numbers[key.index] != kNone;
  }
  // Requires contains(key).
  [[nodiscard]] int of(Key key) const {
    CORRIDOR_EXPECT(contains(key));
    return numbers_[kind_of(key)][key.index];
  }
  // By number.
  [[nodiscard]] const std::vector<Key>& keys() const { return keys_; }

 private:
  static constexpr int kNone = -1;
  static std::size_t kind_of(Key key) { return static_cast<std::size_t>(key.kind); }

  std::array<std::vector<int>, kNumVariableKinds> numbers_;
  std::vector<Key> keys_;
};

}  // namespace corridor::graph
