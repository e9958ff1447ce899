// Memory for the fronts of a tree that changes at every update: chunks of a few sizes, taken from
// large pages and given back, so that in the long run nothing is allocated.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace corridor::backend {

class FrontMemory {
 public:
  // At least `size` doubles, 64-byte aligned, with whatever they held before.
  double* take(std::size_t size);
  // size: as it was asked for.
  void give_back(double* chunk, std::size_t size);
  // Doubles of all pages.
  [[nodiscard]] std::size_t capacity() const { return capacity_; }

 private:
  static constexpr std::size_t kNumClasses = 160;  // four per doubling: far beyond any memory
  struct Free {
    void operator()(double* page) const;
  };

  std::array<std::vector<double*>, kNumClasses> free_;
  std::vector<std::unique_ptr<double[], Free>> pages_;
  double* next_ = nullptr;  // of the newest page, what is not taken yet
  std::size_t num_left_ = 0, capacity_ = 0;
};

}  // namespace corridor::backend
