#include "baselines/karto/window_sweep.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace corridor::karto {
namespace {

// The coarse sweep reads pairs of bytes as one 16-bit lane and keeps the first of the pair.
static_assert(std::endian::native == std::endian::little);

// As many beams as a 16-bit sum of values up to kOccupied can hold.
constexpr std::size_t kMaxBeamsPerBlock = std::numeric_limits<std::uint16_t>::max() / kOccupied;

struct IndexSpan {
  int begin = 0;
  int end = 0;
};

// Positions i for which low <= first + step * i < high.
IndexSpan clip(std::int64_t first, int step, int count, std::int64_t low, std::int64_t high) {
  const auto ceil_div = [step](std::int64_t value) {
    return value <= 0 ? std::int64_t{0} : (value + step - 1) / step;
  };
  const std::int64_t begin = std::min<std::int64_t>(ceil_div(low - first), count);
  const std::int64_t end = std::min<std::int64_t>(ceil_div(high - first), count);
  return {static_cast<int>(begin), static_cast<int>(std::max(begin, end))};
}

class RowSweep {
 public:
  RowSweep(const CorrelationGrid& grid, const SweepWindow& window, EdgeRule edge_rule)
      : grid_(grid),
        window_(window),
        edge_rule_(edge_rule),
        lanes_(static_cast<std::size_t>(window.count)) {}

  void add(std::span<const BeamOffset> offsets, int row, std::uint32_t* sums) {
    const std::int64_t base =
        window_.first_column +
        std::int64_t{window_.first_row + row * window_.step_cells} * grid_.stride();
    for (std::size_t done = 0; done < offsets.size(); done += kMaxBeamsPerBlock) {
      std::fill(lanes_.begin(), lanes_.end(), std::uint16_t{0});
      const std::size_t num = std::min(kMaxBeamsPerBlock, offsets.size() - done);
      for (const BeamOffset& offset : offsets.subspan(done, num)) add_beam(base, offset);
      for (std::size_t i = 0; i < lanes_.size(); ++i) sums[i] += lanes_[i];
    }
  }

 private:
  void add_beam(std::int64_t base, const BeamOffset& offset) {
    const std::int64_t first = base + offset.linear;
    const IndexSpan span = readable(first, offset);
    if (span.begin == span.end) return;
    const std::uint8_t* cells = grid_.cells() + first;
    if (window_.step_cells == 2) {
      add_even(cells, span);
    } else {
      for (int i = span.begin; i < span.end; ++i) {
        lanes_[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(
            lanes_[static_cast<std::size_t>(i)] + cells[i * window_.step_cells]);
      }
    }
  }

  [[nodiscard]] IndexSpan readable(std::int64_t first, const BeamOffset& offset) const {
    const int step = window_.step_cells;
    IndexSpan span = clip(first, step, window_.count, 0, grid_.num_cells());
    if (edge_rule_ == EdgeRule::kStop) {
      const std::int64_t column = std::int64_t{window_.first_column} + offset.column;
      const IndexSpan in_row = clip(column, step, window_.count, 0, grid_.side_cells());
      span = {std::max(span.begin, in_row.begin), std::min(span.end, in_row.end)};
      if (span.begin > span.end) span.end = span.begin;
    }
    return span;
  }

  void add_even(const std::uint8_t* cells, const IndexSpan& span) {
    std::uint16_t* const lanes = lanes_.data();
    for (int i = span.begin; i < span.end; ++i) {
      std::uint16_t pair;
      std::memcpy(&pair, cells + 2 * i, sizeof(pair));
      lanes[i] = static_cast<std::uint16_t>(lanes[i] + (pair & 0xff));
    }
  }

  const CorrelationGrid& grid_;
  const SweepWindow& window_;
  EdgeRule edge_rule_;
  std::vector<std::uint16_t> lanes_;
};

}  // namespace

void sweep_window(const CorrelationGrid& grid, std::span<const BeamOffset> offsets,
                  const SweepWindow& window, EdgeRule edge_rule, std::vector<std::uint32_t>& sums) {
  const auto count = static_cast<std::size_t>(window.count);
  sums.assign(count * count, 0);
  RowSweep sweep(grid, window, edge_rule);
  for (int row = 0; row < window.count; ++row) {
    sweep.add(offsets, row, sums.data() + static_cast<std::size_t>(row) * count);
  }
}

}  // namespace corridor::karto
