// Sets of variables, one behind the other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace corridor::backend {

class VariableSets {
 public:
  void clear() {
    starts_.assign(1, 0);
    members_.clear();
  }
  // Members each once.
  void add(std::span<const int> members) {
    members_.insert(members_.end(), members.begin(), members.end());
    starts_.push_back(members_.size());
  }
  [[nodiscard]] std::size_t size() const { return starts_.size() - 1; }
  [[nodiscard]] std::span<const int> operator[](std::size_t set) const {
    return std::span(members_).subspan(starts_[set], starts_[set + 1] - starts_[set]);
  }
  // Of all sets, one behind the other.
  [[nodiscard]] const std::vector<int>& members() const { return members_; }

 private:
  std::vector<std::size_t> starts_ = {0};
  std::vector<int> members_;
};

}  // namespace corridor::backend
