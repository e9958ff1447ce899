#include "baselines/karto/window_sweep.hpp"

#include <algorithm>

#include "baselines/karto/square_bounds.hpp"
#include "slam/core/expect.hpp"

namespace corridor::karto {
namespace {

// Beams that go through all headings before the next ones do.
constexpr std::size_t kBeamsPerRound = 32;
// The lanes beyond the window read past the last row.
static_assert(CorrelationGrid::kMargin >= TileSweep::kMaxOverrun);

class Sweep {
 public:
  Sweep(const CorrelationGrid& grid, const SweepWindow& window, EdgeRule edge_rule)
      : grid_(grid),
        window_(window),
        edge_rule_(edge_rule),
        first_inner_(-index_of(0)),
        last_inner_(grid.num_cells() - 1 - index_of(window.count - 1) - window.span_cells()),
        tiles_({grid.cells(), grid.stride()}, window) {}

  // All headings, exactly. Neighbouring ones look up neighbouring cells: a few beams go through all
  // of them before the next few, so that the cells stay in the first-level cache.
  void add_all(std::span<HeadingSweep> headings) const {
    std::size_t most_beams = 0;
    for (HeadingSweep& heading : headings) {
      sort_beams(heading);
      for (const BeamOffset& beam : heading.leaving) {
        add_leaving(beam, {0, window_.count}, {0, window_.count}, heading.sums.data());
      }
      most_beams = std::max(most_beams, heading.inner.size());
    }
    for (std::size_t begin = 0; begin < most_beams; begin += kBeamsPerRound) {
      for (HeadingSweep& heading : headings) {
        if (begin >= heading.inner.size()) continue;
        const std::size_t count = std::min(kBeamsPerRound, heading.inner.size() - begin);
        tiles_.add(std::span(heading.inner).subspan(begin, count), heading.sums.data());
      }
    }
  }

  // Branch and bound: only tiles of positions with a bound of at least min_sum.
  void add_where_it_may_reach(std::uint32_t min_sum, std::span<HeadingSweep> headings) const {
    SquareBounds bounds(grid_, window_);
    for (HeadingSweep& heading : headings) {
      sort_beams(heading);
      find_inside(heading);
      bounds.set(heading.inside,
                 heading.inner.size() + heading.leaving.size() - heading.inside.size());
      for (int row = 0; row < window_.count; row += TileSweep::kTileRows) {
        for (int column = 0; column < window_.count; column += tiles_.tile_columns()) {
          const IndexSpan rows{row, std::min(row + TileSweep::kTileRows, window_.count)};
          const IndexSpan columns{column, std::min(column + tiles_.tile_columns(), window_.count)};
          if (!bounds.may_reach(min_sum, rows, columns)) continue;
          tiles_.add_tile(heading.inner, row, column, heading.sums.data());
          for (const BeamOffset& beam : heading.leaving) {
            add_leaving(beam, rows, columns, heading.sums.data());
          }
        }
      }
    }
  }

 private:
  // Tells beams that need not be checked from those that leave the grid somewhere in the window.
  void sort_beams(HeadingSweep& heading) const {
    CORRIDOR_EXPECT(heading.sums.size() == window_.num_positions());
    std::fill(heading.sums.begin(), heading.sums.end(), 0);
    heading.inner.clear();
    heading.leaving.clear();
    for (const BeamOffset& offset : heading.offsets) {
      if (is_inner(offset)) {
        heading.inner.push_back(offset.linear);
      } else if (is_anywhere(offset)) {
        heading.leaving.push_back(offset);
      }
    }
  }

  void find_inside(HeadingSweep& heading) const {
    heading.inside.clear();
    for (const BeamOffset& offset : heading.offsets) {
      if (is_inside(offset)) heading.inside.push_back(offset);
    }
  }

  [[nodiscard]] std::int64_t index_of(int row) const {
    return window_.index_of(row, grid_.stride());
  }
  // True if the beam may be read at every position of the window.
  [[nodiscard]] bool is_inner(const BeamOffset& offset) const {
    if (offset.linear < first_inner_ || offset.linear > last_inner_) return false;
    if (edge_rule_ == EdgeRule::kWrap) return true;
    return stays_within(window_.first_column, offset.column, grid_.side_cells());
  }
  // True if it stays in the grid's rows and columns there.
  [[nodiscard]] bool is_inside(const BeamOffset& offset) const {
    return stays_within(window_.first_column, offset.column, grid_.stride()) &&
           stays_within(window_.first_row, offset.row, grid_.side_cells());
  }
  [[nodiscard]] bool stays_within(int first, int offset, int limit) const {
    const std::int64_t lowest = std::int64_t{first} + offset;
    return lowest >= 0 && lowest + window_.span_cells() < limit;
  }
  // True if there is a position where it is in memory.
  [[nodiscard]] bool is_anywhere(const BeamOffset& offset) const {
    const std::int64_t lowest = index_of(0) + offset.linear;
    const std::int64_t highest = index_of(window_.count - 1) + window_.span_cells() + offset.linear;
    return highest >= 0 && lowest < grid_.num_cells();
  }

  // A beam that leaves the grid somewhere in the window: only its readable positions among those
  // of the given rows and columns.
  void add_leaving(const BeamOffset& offset, const IndexSpan& rows, const IndexSpan& columns,
                   std::uint32_t* sums) const {
    const std::int64_t column = std::int64_t{window_.first_column} + offset.column;
    const IndexSpan in_columns = edge_rule_ == EdgeRule::kStop
                                     ? columns.common(positions_within(column, grid_.side_cells()))
                                     : columns;
    for (int row = rows.begin; row < rows.end; ++row) {
      const std::int64_t first = index_of(row) + offset.linear;
      const IndexSpan readable = in_columns.common(positions_within(first, grid_.num_cells()));
      for (int i = readable.begin; i < readable.end; ++i) {
        sums[row * window_.count + i] +=
            grid_.cells()[first + std::int64_t{window_.step_cells} * i];
      }
    }
  }

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

  const CorrelationGrid& grid_;
  const SweepWindow& window_;
  EdgeRule edge_rule_;
  // Linear offsets that stay in memory at every position.
  std::int64_t first_inner_;
  std::int64_t last_inner_;
  TileSweep tiles_;
};

}  // namespace

void sweep_window(const CorrelationGrid& grid, const SweepWindow& window, EdgeRule edge_rule,
                  std::uint32_t min_sum, std::span<HeadingSweep> headings) {
  const Sweep sweep(grid, window, edge_rule);
  if (min_sum == 0) {
    sweep.add_all(headings);
  } else {
    sweep.add_where_it_may_reach(min_sum, headings);
  }
}

}  // namespace corridor::karto
