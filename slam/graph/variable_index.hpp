// The numbers that a solver gives to variables: the rows of its linear system.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "slam/core/expect.hpp"
#include "slam/graph/key.hpp"
#include "slam/graph/slot_range.hpp"

namespace corridor::graph {

class VariableIndex {
 public:
  // Requires !contains(key); the number must be free.
  void add(Key key, int number) {
    CORRIDOR_EXPECT(number >= 0 && numbers_[kind_of(key)].set(key.index, number));
    const auto slot = static_cast<std::size_t>(number);
    if (slot >= keys_.size()) keys_.resize(slot + 1);
    keys_[slot] = key;
  }
  // Requires contains(key). Its number may be given to another.
  void remove(Key key) { numbers_[kind_of(key)].erase(key.index); }
  [[nodiscard]] bool contains(Key key) const { return numbers_[kind_of(key)].has(key.index); }
  // Requires contains(key).
  [[nodiscard]] int of(Key key) const {
    CORRIDOR_EXPECT(contains(key));
    return numbers_[kind_of(key)][key.index];
  }
  // By number; of numbers that are free what they were last.
  [[nodiscard]] const std::vector<Key>& keys() const { return keys_; }

 private:
  static std::size_t kind_of(Key key) { return static_cast<std::size_t>(key.kind); }

  std::array<SlotRange<int>, kNumVariableKinds> numbers_;
  std::vector<Key> keys_;
};

}  // namespace corridor::graph
