#include "slam/backend/isam2/front_memory.hpp"

#include <algorithm>
#include <bit>
#include <new>

namespace corridor::backend {
namespace {

constexpr std::align_val_t kAlignment{64};
constexpr std::size_t kDoublesPerLine = 8;
constexpr std::size_t kPageSize = std::size_t{1} << 17;  // 1 MiB

struct SizeClass {
  std::size_t number, size;
};

// Four sizes per power of two, of whole cache lines: at most a quarter of a chunk is idle.
SizeClass class_of(std::size_t size) {
  const std::size_t lines = (size + kDoublesPerLine - 1) / kDoublesPerLine;
  if (lines <= 4) return {lines, lines * kDoublesPerLine};
  const auto exponent = std::bit_width(lines - 1) - 3;  // lines in (4, 8] * 2^exponent
  const std::size_t quarters = ((lines - 1) >> exponent) + 1;
  return {4 * exponent + quarters, (quarters << exponent) * kDoublesPerLine};
}

}  // namespace

void FrontMemory::Free::operator()(double* page) const { ::operator delete[](page, kAlignment); }

double* FrontMemory::take(std::size_t size) {
  const SizeClass wanted = class_of(size);
  std::vector<double*>& free = free_[wanted.number];
  if (!free.empty()) {
    double* const chunk = free.back();
    free.pop_back();
    return chunk;
  }
  if (num_left_ < wanted.size) {
    const std::size_t page_size = std::max(kPageSize, wanted.size);
    pages_.emplace_back(
        static_cast<double*>(::operator new[](page_size * sizeof(double), kAlignment)));
    next_ = pages_.back().get();
    num_left_ = page_size;
    capacity_ += page_size;
  }
  double* const chunk = next_;
  next_ += wanted.size;
  num_left_ -= wanted.size;
  return chunk;
}

void FrontMemory::give_back(double* chunk, std::size_t size) {
  free_[class_of(size).number].push_back(chunk);
}

}  // namespace corridor::backend
