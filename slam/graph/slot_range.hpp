// Values by number, for numbers that grow and are mostly given up again in the order in which they
// came: pages of slots, of which those without a value take no memory.
#pragma once

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "slam/core/expect.hpp"

namespace corridor::graph {

template <class T>
class SlotRange {
 public:
  static constexpr std::size_t kPageSize = 256;

  [[nodiscard]] bool has(std::size_t number) const {
    // A page before the first wraps round to one far behind the last.
    const std::size_t page = number / kPageSize - first_page_;
    return page < pages_.size() && pages_[page].are_set[number % kPageSize];
  }
  // Each requires has(number).
  [[nodiscard]] const T& operator[](std::size_t number) const {
    return pages_[number / kPageSize - first_page_].slots[number % kPageSize];
  }
  [[nodiscard]] T& operator[](std::size_t number) {
    return pages_[number / kPageSize - first_page_].slots[number % kPageSize];
  }

  // Sets or replaces; true if it was empty.
  bool set(std::size_t number, const T& value) {
    Page& page = page_of(number);
    if (page.slots.empty()) page.slots.resize(kPageSize);
    const bool is_new = !page.are_set[number % kPageSize];
    page.are_set.set(number % kPageSize);
    page.slots[number % kPageSize] = value;
    return is_new;
  }
  // Requires has(number). A page without a value gives up its slots, and pages at the start their
  // place once they are the larger part: a window that moves along costs a fixed effort per step
  // and does not grow, also where some old number stays.
  void erase(std::size_t number) {
    CORRIDOR_EXPECT(has(number));
    Page& page = page_of(number);
    page.are_set.reset(number % kPageSize);
    // What it holds elsewhere is of no use any more.
    if constexpr (!std::is_trivially_destructible_v<T>) page.slots[number % kPageSize] = T();
    if (page.are_set.any()) return;
    page.slots = {};
    const auto is_used = [](const Page& p) { return !p.slots.empty(); };
    const auto first = std::find_if(pages_.begin(), pages_.end(), is_used);
    const auto num_empty = static_cast<std::size_t>(first - pages_.begin());
    if (2 * num_empty < pages_.size()) return;
    pages_.erase(pages_.begin(), first);
    first_page_ += num_empty;
  }
  // Calls visit(number, value) for every one that is set, ascending.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t p = 0; p < pages_.size(); ++p) {
      for (std::size_t k = 0; k < pages_[p].slots.size(); ++k) {
        if (pages_[p].are_set[k]) visit((first_page_ + p) * kPageSize + k, pages_[p].slots[k]);
      }
    }
  }
  // Slots that take memory, empty ones included.
  [[nodiscard]] std::size_t num_slots() const {
    std::size_t sum = 0;
    for (const Page& page : pages_) sum += page.slots.size();
    return sum;
  }

 private:
  struct Page {
    std::vector<T> slots;  // kPageSize, or none
    std::bitset<kPageSize> are_set;
  };

  Page& page_of(std::size_t number) {
    const std::size_t wanted = number / kPageSize;
    if (pages_.empty()) first_page_ = wanted;
    if (wanted < first_page_) {
      // As many again at least, so that descending numbers do not move all of them every time.
      const std::size_t gap = std::max(first_page_ - wanted, std::min(first_page_, pages_.size()));
      pages_.insert(pages_.begin(), gap, Page());
      first_page_ -= gap;
    }
    if (wanted - first_page_ >= pages_.size()) pages_.resize(wanted - first_page_ + 1);
    return pages_[wanted - first_page_];
  }

  std::size_t first_page_ = 0;
  std::vector<Page> pages_;
};

}  // namespace corridor::graph
