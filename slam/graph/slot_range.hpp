// A vector over a range of numbers that grows at its end and is given up from its start: slots from
// the lowest number in use to the highest.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "slam/core/expect.hpp"

namespace corridor::graph {

template <class T>
class SlotRange {
 public:
  [[nodiscard]] bool has(std::size_t number) const {
    return number >= first_ && number - first_ < slots_.size() && are_set_[number - first_];
  }
  // Each requires has(number).
  [[nodiscard]] const T& operator[](std::size_t number) const { return slots_[number - first_]; }
  [[nodiscard]] T& operator[](std::size_t number) { return slots_[number - first_]; }

  // Sets or replaces; true if it was empty.
  bool set(std::size_t number, const T& value) {
    if (slots_.empty()) first_ = number;
    if (number < first_) {
      // As many again at least, so that descending numbers do not move all of them every time.
      const std::size_t gap = std::max(first_ - number, std::min(first_, slots_.size()));
      slots_.insert(slots_.begin(), gap, value);
      are_set_.insert(are_set_.begin(), gap, false);
      first_ -= gap;
      num_empty_ = 0;
    }
    const std::size_t slot = number - first_;
    if (slot >= slots_.size()) {
      slots_.resize(slot + 1, value);
      are_set_.resize(slot + 1, false);
    }
    num_empty_ = std::min(num_empty_, slot);
    slots_[slot] = value;
    const bool is_new = !are_set_[slot];
    are_set_[slot] = true;
    return is_new;
  }
  // Requires has(number). Gives up empty slots at the start once they are the larger part, so that
  // a window that moves along costs a fixed effort per step and does not grow.
  void erase(std::size_t number) {
    CORRIDOR_EXPECT(has(number));
    are_set_[number - first_] = false;
    while (num_empty_ < slots_.size() && !are_set_[num_empty_]) ++num_empty_;
    if (2 * num_empty_ < slots_.size()) return;
    const auto end = static_cast<std::ptrdiff_t>(num_empty_);
    slots_.erase(slots_.begin(), slots_.begin() + end);
    are_set_.erase(are_set_.begin(), are_set_.begin() + end);
    first_ += num_empty_;
    num_empty_ = 0;
  }
  // Calls visit(number, value) for every one that is set, ascending.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t k = 0; k < slots_.size(); ++k) {
      if (are_set_[k]) visit(first_ + k, slots_[k]);
    }
  }
  // Slots kept, empty ones included.
  [[nodiscard]] std::size_t num_slots() const { return slots_.size(); }

 private:
  std::size_t first_ = 0;
  std::vector<T> slots_;
  std::vector<bool> are_set_;
  std::size_t num_empty_ = 0;  // at the start, at least
};

}  // namespace corridor::graph
