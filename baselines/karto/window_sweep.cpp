#include "baselines/karto/window_sweep.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace corridor::karto {
namespace {

// As many beams as a 16-bit sum of values up to kOccupied can hold.
constexpr std::size_t kMaxBeamsPerBlock = std::numeric_limits<std::uint16_t>::max() / kOccupied;
constexpr int kLanes = 16;
constexpr int kBytesPerBlock = 2 * kLanes;
// The coarse sweep reads pairs of bytes as one 16-bit lane and keeps the first of the pair.
constexpr std::uint16_t kLowByte = 0xff;
static_assert(std::endian::native == std::endian::little);
// The lanes beyond the window read past the last row.
static_assert(CorrelationGrid::kMargin >= kBytesPerBlock);

// A vector of GCC and Clang: an array would travel through memory, several times slower.
using Lanes [[gnu::vector_size(kBytesPerBlock)]] = std::uint16_t;

class Sweep {
 public:
  Sweep(const CorrelationGrid& grid, const SweepWindow& window, EdgeRule edge_rule,
        std::vector<std::uint32_t>& sums)
      : grid_(grid), window_(window), edge_rule_(edge_rule), sums_(sums) {}

  void run(std::span<const BeamOffset> offsets) {
    inner_.clear();
    for (const BeamOffset& offset : offsets) {
      if (is_inner(offset)) {
        inner_.push_back(offset.linear);
      } else {
        add_checked(offset);
      }
    }
    for (std::size_t done = 0; done < inner_.size(); done += kMaxBeamsPerBlock) {
      const std::size_t count = std::min(kMaxBeamsPerBlock, inner_.size() - done);
      const std::span<const std::int32_t> beams(inner_.data() + done, count);
      for (int row = 0; row < window_.count; ++row) add_row(beams, row);
    }
  }

 private:
  [[nodiscard]] std::int64_t index_of(int row) const {
    return window_.first_column +
           std::int64_t{window_.first_row + row * window_.step_cells} * grid_.stride();
  }
  // True if the beam may be read at every position of the window.
  [[nodiscard]] bool is_inner(const BeamOffset& offset) const {
    const int span_cells = window_.step_cells * (window_.count - 1);
    const std::int64_t lowest = index_of(0) + offset.linear;
    const std::int64_t highest = index_of(window_.count - 1) + span_cells + offset.linear;
    if (lowest < 0 || highest >= grid_.num_cells()) return false;
    if (edge_rule_ == EdgeRule::kWrap) return true;
    const std::int64_t column = std::int64_t{window_.first_column} + offset.column;
    return column >= 0 && column + span_cells < grid_.side_cells();
  }

  // A beam that leaves the grid somewhere in the window: only its readable positions, row by row.
  void add_checked(const BeamOffset& offset) {
    const std::int64_t column = std::int64_t{window_.first_column} + offset.column;
    const IndexSpan in_columns = edge_rule_ == EdgeRule::kStop
                                     ? positions_within(column, grid_.side_cells())
                                     : IndexSpan{0, window_.count};
    for (int row = 0; row < window_.count; ++row) {
      const std::int64_t first = index_of(row) + offset.linear;
      const IndexSpan in_memory = positions_within(first, grid_.num_cells());
      const int end = std::min(in_columns.end, in_memory.end);
      for (int i = std::max(in_columns.begin, in_memory.begin); i < end; ++i) {
        sum(row, i) += grid_.cells()[first + std::int64_t{window_.step_cells} * i];
      }
    }
  }

  struct IndexSpan {
    int begin;
    int end;
  };

  // Positions i of a row with 0 <= first + step * i < limit.
  [[nodiscard]] IndexSpan positions_within(std::int64_t first, std::int64_t limit) const {
    const int step = window_.step_cells;
    if (first >= 0 && first + std::int64_t{step} * (window_.count - 1) < limit) {
      return {0, window_.count};
    }
    const auto first_at_or_above = [&](std::int64_t value) {
      const std::int64_t distance = value - first;
      const std::int64_t position = distance <= 0 ? 0 : (distance + step - 1) / step;
      return static_cast<int>(std::min<std::int64_t>(position, window_.count));
    };
    return {first_at_or_above(0), first_at_or_above(limit)};
  }

  void add_row(std::span<const std::int32_t> beams, int row) {
    const std::uint8_t* const cells = grid_.cells() + index_of(row);
    if (window_.step_cells != 2) {
      for (int i = 0; i < window_.count; ++i) {
        for (const std::int32_t beam : beams) sum(row, i) += cells[beam + i * window_.step_cells];
      }
      return;
    }
    for (int first = 0; first < window_.count; first += kLanes) {
      const Lanes lanes = add_even_bytes(beams, cells + 2 * first);
      const int count = std::min(kLanes, window_.count - first);
      for (int i = 0; i < count; ++i) sum(row, first + i) += lanes[i];
    }
  }

  // lanes[k] = sum over beams of cells[beam + 2 k].
  static Lanes add_even_bytes(std::span<const std::int32_t> beams, const std::uint8_t* cells) {
    Lanes lanes{};
    for (const std::int32_t beam : beams) {
      Lanes pairs;
      std::memcpy(&pairs, cells + beam, sizeof(pairs));
      lanes += pairs & kLowByte;
    }
    return lanes;
  }

  [[nodiscard]] std::uint32_t& sum(int row, int column) {
    return sums_[static_cast<std::size_t>(row * window_.count + column)];
  }

  const CorrelationGrid& grid_;
  const SweepWindow& window_;
  EdgeRule edge_rule_;
  std::vector<std::uint32_t>& sums_;
  std::vector<std::int32_t> inner_;
};

}  // namespace

void sweep_window(const CorrelationGrid& grid, std::span<const BeamOffset> offsets,
                  const SweepWindow& window, EdgeRule edge_rule, std::vector<std::uint32_t>& sums) {
  const auto count = static_cast<std::size_t>(window.count);
  sums.assign(count * count, 0);
  Sweep(grid, window, edge_rule, sums).run(offsets);
}

}  // namespace corridor::karto
