#include "slam/graph/slot_range.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <utility>
#include <vector>

namespace corridor::graph {
namespace {

RC_GTEST_PROP(SlotRange, HoldsWhatAMapHoldsAfterAnySettingAndErasing,
              (const std::vector<std::pair<std::uint16_t, bool>>& drawn)) {
  // Over some pages, and often the same numbers again.
  constexpr std::size_t kNumNumbers = 1200;
  std::vector<std::pair<std::size_t, bool>> steps;
  for (const auto& [number, is_set] : drawn) steps.emplace_back(number * 37U % kNumNumbers, is_set);
  for (const auto& [number, is_set] : drawn) steps.emplace_back(number * 37U % kNumNumbers, false);
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
    for (std::size_t k = 0; k < kNumNumbers; ++k) {
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
    ASSERT_LE(slots.num_slots(), 2 * SlotRange<int>::kPageSize);
  }
}

TEST(SlotRange, AnOldNumberThatStaysDoesNotKeepTheSlotsBetween) {
  SlotRange<int> slots;
  slots.set(0, 7);
  for (std::size_t k = 1; k < 100000; ++k) {
    slots.set(k, 1);
    if (k > 10) slots.erase(k - 10);
    ASSERT_LE(slots.num_slots(), 3 * SlotRange<int>::kPageSize);
  }
  EXPECT_EQ(slots[0], 7);
}

}  // namespace
}  // namespace corridor::graph
