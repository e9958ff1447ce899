// The sweep by rows against the definition, pose by pose.
#include "baselines/karto/window_sweep.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "baselines/karto/pooled_grid.hpp"
#include "baselines/karto/square_bounds.hpp"
#include "slam/core/rng.hpp"

namespace corridor::karto {
namespace {

std::vector<std::uint32_t> by_definition(const CorrelationGrid& grid,
                                         const std::vector<BeamOffset>& offsets,
                                         const SweepWindow& window, EdgeRule rule) {
  std::vector<std::uint32_t> sums;
  for (int j = 0; j < window.count; ++j) {
    for (int i = 0; i < window.count; ++i) {
      std::uint32_t sum = 0;
      for (const BeamOffset& offset : offsets) {
        const int column = window.first_column + window.step_cells * i;
        const int row = window.first_row + window.step_cells * j;
        const std::int64_t index = std::int64_t{row} * grid.stride() + column + offset.linear;
        if (index < 0 || index >= grid.num_cells()) continue;
        const int end_column = column + offset.column;
        if (rule == EdgeRule::kStop && (end_column < 0 || end_column >= grid.side_cells()))
          continue;
        sum += grid.cells()[index];
      }
      sums.push_back(sum);
    }
  }
  return sums;
}

CorrelationGrid drawn_grid(const GridSpec& spec, const PointColumns& points_m) {
  CorrelationGrid grid(spec, 1);
  grid.reset({0, 0});
  grid.blocks().want_all();
  GridCells cells;
  grid.find_cells(points_m, cells);
  grid.occupy(cells, cells.index.size());
  return grid;
}

std::vector<std::uint32_t> swept(const CorrelationGrid& grid,
                                 const std::vector<BeamOffset>& offsets, const SweepWindow& window,
                                 EdgeRule rule, std::uint32_t min_sum = 0) {
  std::vector<std::uint32_t> sums(window.num_positions(), 77);
  HeadingSweep heading{offsets, sums, {}, {}, {}};
  sweep_window(grid, window, rule, min_sum, {&heading, 1});
  return sums;
}

RC_GTEST_PROP(WindowSweep, EqualsTheSumOverBeamsAtEveryPosition, (std::uint64_t seed)) {
  Rng rng(seed);
  PointColumns points(60, 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    points.row(i) << rng.uniform(-2, 2), rng.uniform(-2, 2);
  }
  const CorrelationGrid grid = drawn_grid({0.05, 1.0, 1.5, 0.03}, points);
  // Twice the grid's reach, so that beams leave it on all sides; more beams than 16 bits can sum.
  PointColumns beams(801, 2);
  for (Eigen::Index i = 0; i < beams.rows(); ++i) {
    beams.row(i) << rng.uniform(-4, 4), rng.uniform(-4, 4);
  }
  beams.row(800) << 80, 3;
  std::vector<BeamOffset> offsets;
  fill_beam_offsets(beams, 0.3, grid, offsets);
  const int middle = grid.middle_cell();
  const int step = 1 + static_cast<int>(rng.below(2));
  const int count = 1 + static_cast<int>(rng.below(20));
  const SweepWindow window{middle - count * step / 2, middle - count * step / 2, step, count};
  for (const EdgeRule rule : {EdgeRule::kWrap, EdgeRule::kStop}) {
    const std::vector<std::uint32_t> exact = by_definition(grid, offsets, window, rule);
    RC_ASSERT(swept(grid, offsets, window, rule) == exact);
    // With a bound: exact from it on, and never too large below.
    const std::uint32_t min_sum = exact[rng.below(static_cast<std::uint32_t>(exact.size()))];
    const std::vector<std::uint32_t> bounded = swept(grid, offsets, window, rule, min_sum);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const bool is_right = exact[i] >= min_sum ? bounded[i] == exact[i] : bounded[i] <= exact[i];
      RC_ASSERT(is_right);
    }
  }
}

// Beams that stay inside, some of which meet something drawn: a window that the bound can thin out.
struct InnerScene {
  explicit InnerScene(Rng& rng)
      : grid(drawn_grid({0.05, 3.2, 1.5, 0.03}, points_of(rng))),
        step(1 + static_cast<int>(rng.below(2))),
        count(1 + static_cast<int>(rng.below(64 / static_cast<std::uint32_t>(step)))),
        window{grid.middle_cell() - count * step / 2, grid.middle_cell() - count * step / 2, step,
               count} {
    // What is drawn, seen from somewhere in the window.
    const Eigen::RowVector2d from(rng.uniform(-1.4, 1.4), rng.uniform(-1.4, 1.4));
    const PointColumns beams = drawn.rowwise() - from;
    fill_beam_offsets(beams, 0, grid, offsets);
  }

  PointColumns points_of(Rng& rng) {
    drawn.resize(40, 2);
    const Eigen::RowVector2d middle(rng.uniform(-1, 1), rng.uniform(-1, 1));
    for (Eigen::Index i = 0; i < drawn.rows(); ++i) {
      drawn.row(i) = middle + Eigen::RowVector2d(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5));
    }
    return drawn;
  }

  PointColumns drawn;
  CorrelationGrid grid;
  int step, count;
  SweepWindow window;
  std::vector<BeamOffset> offsets;
};

TEST(WindowSweep, LeavesOutPositionsBelowABoundAndNoneThatReachesIt) {
  int num_left_out = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    const InnerScene scene(rng);
    for (const EdgeRule rule : {EdgeRule::kWrap, EdgeRule::kStop}) {
      const auto exact = by_definition(scene.grid, scene.offsets, scene.window, rule);
      const std::uint32_t most = *std::max_element(exact.begin(), exact.end());
      const auto min_sum = static_cast<std::uint32_t>(rng.uniform(0.7, 1.0) * most);
      const auto bounded = swept(scene.grid, scene.offsets, scene.window, rule, min_sum);
      for (std::size_t i = 0; i < exact.size(); ++i) {
        ASSERT_LE(bounded[i], exact[i]) << seed;
        if (exact[i] >= min_sum) {
          ASSERT_EQ(bounded[i], exact[i]) << seed;
        }
        num_left_out += bounded[i] < exact[i] ? 1 : 0;
      }
    }
  }
  EXPECT_GT(num_left_out, 1000);
}

std::uint32_t largest(const CorrelationGrid& grid, const Eigen::Vector2i& first, int side_cells) {
  std::uint32_t found = 0;
  for (int row = std::max(first.y(), 0); row < first.y() + side_cells; ++row) {
    for (int column = std::max(first.x(), 0); column < first.x() + side_cells; ++column) {
      if (row >= grid.side_cells() || column >= grid.stride()) continue;
      found = std::max<std::uint32_t>(found, grid.cells()[grid.linear_index({column, row})]);
    }
  }
  return found;
}

RC_GTEST_PROP(PooledGrid, HoldsTheLargestValueOfSixteenBySixteenCells, (std::uint64_t seed)) {
  Rng rng(seed);
  PointColumns points(12, 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    points.row(i) << rng.uniform(-1.6, 1.6), rng.uniform(-1.6, 1.6);
  }
  // Kernels of 3 cells and of 41, which reach beyond the next cell of the pooled grid.
  const CorrelationGrid grid = drawn_grid({0.05, 0.2, 1.5, rng.below(2) == 0 ? 0.03 : 0.5}, points);
  const PooledGrid pooled(grid);
  for (int row = 0; row < grid.side_cells(); row += PooledGrid::kSide_cells) {
    for (int column = 0; column < grid.stride(); column += PooledGrid::kSide_cells) {
      const std::int32_t index =
          row / PooledGrid::kSide_cells * pooled.stride() + column / PooledGrid::kSide_cells;
      RC_ASSERT(pooled.cells()[index] == largest(grid, {column, row}, 16));
    }
  }
}

// Twelve end points in one corner, looked up from a window of which the rest cannot see them.
TEST(SquareBounds, RuleOutWhatIsFarFromEverythingDrawn) {
  PointColumns points(12, 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) << 1.4, 1.0 + 0.05 * double(i);
  const CorrelationGrid grid = drawn_grid({0.05, 3.2, 1.5, 0.03}, points);
  std::vector<BeamOffset> offsets;
  fill_beam_offsets(points, 0, grid, offsets);
  ASSERT_EQ(offsets.size(), 12u);
  const int first = grid.middle_cell() - 32;
  SquareBounds bounds(grid, {first, first, 2, 33});
  bounds.set(offsets, 0);
  EXPECT_TRUE(bounds.may_reach(1200, {16, 17}, {16, 17}));  // where all beams meet their points
  EXPECT_FALSE(bounds.may_reach(1, {0, 4}, {0, 33}));
  EXPECT_FALSE(bounds.may_reach(1, {0, 33}, {28, 33}));
  bounds.set(offsets, 3);
  EXPECT_TRUE(bounds.may_reach(300, {0, 4}, {0, 33}));
  EXPECT_FALSE(bounds.may_reach(301, {0, 4}, {0, 33}));
}

TEST(WindowSweep, ABeamThatLeavesSidewaysReadsTheNextRowOnlyWhereRowsWrap) {
  // The end point of one row up, one whole stride to the left: reached by going right.
  PointColumns points(1, 2);
  points << -0.9, 0.05;
  const CorrelationGrid grid = drawn_grid({0.05, 0.2, 1.0, 0.03}, points);
  const int middle = grid.middle_cell();
  const Eigen::Vector2i cell = grid.cell_of(points.row(0).transpose());
  const std::int32_t right = cell.x() - middle + grid.stride();
  const std::vector<BeamOffset> offsets = {{right, right, 0}};
  EXPECT_EQ(swept(grid, offsets, {middle, middle, 1, 1}, EdgeRule::kWrap).front(), 100u);
  EXPECT_EQ(swept(grid, offsets, {middle, middle, 1, 1}, EdgeRule::kStop).front(), 0u);
}

TEST(BeamOffsets, LeaveOutWhatIsOutsideEveryGrid) {
  const CorrelationGrid grid({0.05, 0.2, 1.0, 0.03}, 1);
  PointColumns beams(4, 2);
  beams << 0, 1e4, 0.5, 0.1, 0, -1e4, 1e4, 0;
  std::vector<BeamOffset> offsets;
  fill_beam_offsets(beams, 0, grid, offsets);
  ASSERT_EQ(offsets.size(), 1u);
  EXPECT_EQ(offsets.front().column, 10);
  EXPECT_EQ(offsets.front().row, 2);
  EXPECT_EQ(offsets.front().linear, 10 + 2 * grid.stride());
}

}  // namespace
}  // namespace corridor::karto
