#include "baselines/karto/window_sweep.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "slam/core/expect.hpp"

namespace corridor::karto {
namespace {

constexpr int kBytes = 32;          // of one vector
constexpr int kLanes = kBytes / 2;  // 16-bit sums in it
constexpr int kSmallWindow = 32;    // not worth a second thread
// Beams between two looks at whether a tile can still reach the sum that is asked for; as many go
// through all headings at once where none is.
constexpr std::size_t kBeamsPerChunk = 32;
static_assert(kBeamsPerChunk * kOccupied <= std::numeric_limits<std::uint16_t>::max());
// A pair of bytes is read as one 16-bit lane: its first byte is the low one.
constexpr std::uint16_t kLowByte = 0xff;
constexpr int kByteBits = 8;
static_assert(std::endian::native == std::endian::little);
static_assert(2 * kOccupied <= std::numeric_limits<std::uint8_t>::max());
// The lanes beyond the window read past the last row.
static_assert(CorrelationGrid::kMargin >= 3 * kBytes);

// Vectors of GCC and Clang, for whatever instructions the build allows: arrays would travel through
// memory, several times slower.
using Bytes [[gnu::vector_size(kBytes)]] = std::uint8_t;
using Lanes [[gnu::vector_size(kBytes)]] = std::uint16_t;

Bytes load(const std::uint8_t* cells) {
  Bytes bytes;
  std::memcpy(&bytes, cells, sizeof(bytes));
  return bytes;
}

// Rows of positions that are summed at once, and vectors of grid cells along each.
template <int kStepCells, int kNumRows, int kNumVectors>
struct TileShape {
  static constexpr int kStep = kStepCells;
  static constexpr int kRows = kNumRows;
  static constexpr int kVectors = kNumVectors;
  static constexpr int kColumnsPerVector = kBytes / kStep;
  static constexpr int kColumns = kVectors * kColumnsPerVector;
};

// 16-bit sums of the positions of a tile: those at even cells, and with steps of one cell those at
// odd cells as well.
template <class Shape>
class TileSums {
 public:
  void add(const std::uint8_t* cells, std::ptrdiff_t row_bytes,
           std::span<const std::int32_t> beams) {
    std::size_t i = 0;
    // Two values fit into a byte.
    for (; i + 2 <= beams.size(); i += 2) {
      for (int v = 0; v < kNumVectors; ++v) {
        const std::uint8_t* const at = cells + offset_of(v, row_bytes);
        add(v, load(at + beams[i]) + load(at + beams[i + 1]));
      }
    }
    if (i == beams.size()) return;
    for (int v = 0; v < kNumVectors; ++v) add(v, load(cells + offset_of(v, row_bytes) + beams[i]));
  }

  // sums[i] += sum at column i of the row, for i < count.
  void flush(int row, int count, std::uint32_t* sums) const {
    for (int first = 0; first < count; first += Shape::kColumnsPerVector) {
      const int v = row * Shape::kVectors + first / Shape::kColumnsPerVector;
      const int end = std::min(count - first, Shape::kColumnsPerVector);
      for (int i = 0; i < end; ++i) {
        if constexpr (Shape::kStep == 2) {
          sums[first + i] += even_[v][i];
        } else {
          sums[first + i] += i % 2 == 0 ? even_[v][i / 2] : odd_[v][i / 2];
        }
      }
    }
  }

 private:
  static constexpr int kNumVectors = Shape::kRows * Shape::kVectors;

  static std::ptrdiff_t offset_of(int vector, std::ptrdiff_t row_bytes) {
    return vector / Shape::kVectors * row_bytes + vector % Shape::kVectors * kBytes;
  }
  void add(int v, Bytes bytes) {
    const auto pairs = reinterpret_cast<Lanes>(bytes);
    even_[v] += pairs & kLowByte;
    if constexpr (Shape::kStep == 1) odd_[v] += pairs >> kByteBits;
  }

  std::array<Lanes, kNumVectors> even_{};
  std::array<Lanes, Shape::kStep == 1 ? kNumVectors : 1> odd_{};
};

class Sweep {
 public:
  Sweep(const CorrelationGrid& grid, const SweepWindow& window, EdgeRule edge_rule)
      : grid_(grid),
        window_(window),
        edge_rule_(edge_rule),
        first_inner_(-index_of(0)),
        last_inner_(grid.num_cells() - 1 - index_of(window.count - 1) - span_cells()) {}

  // Sums what has to be checked and collects what need not.
  void start(HeadingSweep& heading) const {
    CORRIDOR_EXPECT(heading.sums.size() == window_.num_positions());
    std::fill(heading.sums.begin(), heading.sums.end(), 0);
    heading.inner.clear();
    for (const BeamOffset& offset : heading.offsets) {
      if (is_inner(offset)) {
        heading.inner.push_back(offset.linear);
      } else {
        add_checked(offset, heading.sums.data());
      }
    }
  }

  // Adds beams to all positions, tile by tile; gives tiles up that cannot reach min_sum.
  void add(std::span<const std::int32_t> beams, std::uint32_t min_sum, std::uint32_t* sums) const {
    if (window_.step_cells == 1) {
      add_tiles<1>(beams, min_sum, sums);
    } else {
      add_tiles<2>(beams, min_sum, sums);
    }
  }

 private:
  [[nodiscard]] std::int64_t index_of(int row) const {
    return window_.first_column +
           std::int64_t{window_.first_row + row * window_.step_cells} * grid_.stride();
  }
  [[nodiscard]] int span_cells() const { return window_.step_cells * (window_.count - 1); }
  // True if the beam may be read at every position of the window.
  [[nodiscard]] bool is_inner(const BeamOffset& offset) const {
    if (offset.linear < first_inner_ || offset.linear > last_inner_) return false;
    if (edge_rule_ == EdgeRule::kWrap) return true;
    const std::int64_t column = std::int64_t{window_.first_column} + offset.column;
    return column >= 0 && column + span_cells() < grid_.side_cells();
  }
  // True if there is a position where it is in memory.
  [[nodiscard]] bool is_anywhere(const BeamOffset& offset) const {
    const std::int64_t lowest = index_of(0) + offset.linear;
    const std::int64_t highest = index_of(window_.count - 1) + span_cells() + offset.linear;
    return highest >= 0 && lowest < grid_.num_cells();
  }

  // A beam that leaves the grid somewhere in the window: only its readable positions, row by row.
  void add_checked(const BeamOffset& offset, std::uint32_t* sums) const {
    if (!is_anywhere(offset)) return;
    const std::int64_t column = std::int64_t{window_.first_column} + offset.column;
    const IndexSpan in_columns = edge_rule_ == EdgeRule::kStop
                                     ? positions_within(column, grid_.side_cells())
                                     : IndexSpan{0, window_.count};
    for (int row = 0; row < window_.count; ++row) {
      const std::int64_t first = index_of(row) + offset.linear;
      const IndexSpan in_memory = positions_within(first, grid_.num_cells());
      const int end = std::min(in_columns.end, in_memory.end);
      for (int i = std::max(in_columns.begin, in_memory.begin); i < end; ++i) {
        sums[row * window_.count + i] +=
            grid_.cells()[first + std::int64_t{window_.step_cells} * i];
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

  // A wide window by wide tiles, which use up the cache lines they touch.
  template <int kStep>
  void add_tiles(std::span<const std::int32_t> beams, std::uint32_t min_sum,
                 std::uint32_t* sums) const {
    int row = 0;
    if (window_.count > 2 * kBytes / kStep)
      row = add_rows<TileShape<kStep, 2, 3>>(beams, row, min_sum, sums);
    row = add_rows<TileShape<kStep, 4, 1>>(beams, row, min_sum, sums);
    row = add_rows<TileShape<kStep, 3, 1>>(beams, row, min_sum, sums);
    add_rows<TileShape<kStep, 1, 1>>(beams, row, min_sum, sums);
  }

  // As many rows from `row` on as tiles of this shape take; the first row that is left.
  template <class Shape>
  int add_rows(std::span<const std::int32_t> beams, int row, std::uint32_t min_sum,
               std::uint32_t* sums) const {
    for (; row + Shape::kRows <= window_.count; row += Shape::kRows) {
      for (int column = 0; column < window_.count; column += Shape::kColumns) {
        add_tile<Shape>(beams, row, column, min_sum, sums);
      }
    }
    return row;
  }

  template <class Shape>
  void add_tile(std::span<const std::int32_t> beams, int first_row, int first_column,
                std::uint32_t min_sum, std::uint32_t* sums) const {
    const std::uint8_t* const cells =
        grid_.cells() + index_of(first_row) + Shape::kStep * first_column;
    const std::ptrdiff_t row_bytes = std::ptrdiff_t{Shape::kStep} * grid_.stride();
    const int count = std::min(Shape::kColumns, window_.count - first_column);
    while (!beams.empty()) {
      const std::size_t num_beams = std::min(beams.size(), kBeamsPerChunk);
      TileSums<Shape> tile;
      tile.add(cells, row_bytes, beams.first(num_beams));
      beams = beams.subspan(num_beams);
      std::uint32_t largest = 0;
      for (int row = 0; row < Shape::kRows; ++row) {
        std::uint32_t* const row_sums = sums + (first_row + row) * window_.count + first_column;
        tile.flush(row, count, row_sums);
        if (min_sum == 0) continue;
        largest = std::max(largest, *std::max_element(row_sums, row_sums + count));
      }
      if (largest + kOccupied * beams.size() < min_sum) return;
    }
  }

  const CorrelationGrid& grid_;
  const SweepWindow& window_;
  EdgeRule edge_rule_;
  // Linear offsets that stay in memory at every position.
  std::int64_t first_inner_;
  std::int64_t last_inner_;
};

// Neighbouring headings look up neighbouring cells: without a bound, a few beams go through all of
// them before the next few, so that the cells stay in the first-level cache.
void sweep_headings(const Sweep& sweep, std::uint32_t min_sum, std::span<HeadingSweep> headings) {
  std::size_t most_beams = 0;
  for (HeadingSweep& heading : headings) {
    sweep.start(heading);
    if (min_sum > 0) sweep.add(heading.inner, min_sum, heading.sums.data());
    most_beams = std::max(most_beams, heading.inner.size());
  }
  if (min_sum > 0) return;
  for (std::size_t begin = 0; begin < most_beams; begin += kBeamsPerChunk) {
    for (HeadingSweep& heading : headings) {
      if (begin >= heading.inner.size()) continue;
      const std::size_t count = std::min(kBeamsPerChunk, heading.inner.size() - begin);
      sweep.add(std::span(heading.inner).subspan(begin, count), 0, heading.sums.data());
    }
  }
}

}  // namespace

void sweep_window(const CorrelationGrid& grid, const SweepWindow& window, EdgeRule edge_rule,
                  std::uint32_t min_sum, std::span<HeadingSweep> headings) {
  CORRIDOR_EXPECT(window.step_cells == 1 || window.step_cells == 2);
  const Sweep sweep(grid, window, edge_rule);
  const auto num_threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  if (num_threads == 1 || window.count < kSmallWindow) {
    return sweep_headings(sweep, min_sum, headings);
  }
  const std::size_t per_task = (headings.size() + num_threads - 1) / num_threads;
  tbb::parallel_for(std::size_t{0}, headings.size(), per_task, [&](std::size_t begin) {
    const std::size_t count = std::min(per_task, headings.size() - begin);
    sweep_headings(sweep, min_sum, headings.subspan(begin, count));
  });
}

}  // namespace corridor::karto
