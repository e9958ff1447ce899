#include "slam/graph/slot_range.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <utility>
#include <vector>

namespace corridor::graph {
namespace {

RC_GTEST_PROP(SlotRange, HoldsWhatAMapHoldsAfterAnySettingAndErasing,
              (const std::vector<std::pair<std::uint8_t, bool>>& steps)) {
  SlotRange<int> slots;
  std::map<std::size_t, int> expected;
  int value = 0;
  for (const auto& [number, is_set] : steps) {
    if (is_set) {
      RC_ASSERT(slots.set(number, ++value) == !expected.contains(number));
      expected[number] = value;
    } else if (expected.erase(number) > 0) {
      slots.erase(number);
    }
    for (std::size_t k = 0; k < 256; ++k) {
      RC_ASSERT(slots.has(k) == expected.contains(k));
      if (slots.has(k)) RC_ASSERT(slots[k] == expected[k]);
    }
  }
  std::map<std::size_t, int> visited;
  slots.for_each([&](std::size_t number, int found) { visited.emplace(number, found); });
  RC_ASSERT(visited == expected);
}

TEST(SlotRange, AWindowThatMovesAlongDoesNotGrow) {
  SlotRange<int> slots;
  for (std::size_t k = 0; k < 10000; ++k) {
    slots.set(k, 1);
    if (k >= 10) slots.erase(k - 10);
    ASSERT_LE(slots.num_slots(), 32u);
  }
}

}  // namespace
}  // namespace corridor::graph
