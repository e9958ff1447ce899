// The sweep by rows against the definition, pose by pose.
#include "baselines/karto/window_sweep.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

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

RC_GTEST_PROP(WindowSweep, EqualsTheSumOverBeamsAtEveryPosition, (std::uint64_t seed)) {
  Rng rng(seed);
  CorrelationGrid grid({0.05, 1.0, 1.5, 0.03});
  grid.reset({0, 0});
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 60; ++i) points.emplace_back(rng.uniform(-2, 2), rng.uniform(-2, 2));
  grid.add_points(points);
  // Twice the grid's reach, so that beams leave it on all sides; more beams than 16 bits can sum.
  std::vector<Eigen::Vector2d> beams;
  for (int i = 0; i < 800; ++i) beams.emplace_back(rng.uniform(-4, 4), rng.uniform(-4, 4));
  beams.emplace_back(80, 3);
  std::vector<BeamOffset> offsets;
  fill_beam_offsets(beams, 0.3, grid, offsets);
  const int middle = (grid.side_cells() - 1) / 2;
  const int step = 1 + static_cast<int>(rng.below(3));
  const int count = 1 + static_cast<int>(rng.below(20));
  const SweepWindow window{middle - count * step / 2, middle - count * step / 2, step, count};
  for (const EdgeRule rule : {EdgeRule::kWrap, EdgeRule::kStop}) {
    std::vector<std::uint32_t> sums;
    sweep_window(grid, offsets, window, rule, sums);
    RC_ASSERT(sums == by_definition(grid, offsets, window, rule));
  }
}

TEST(WindowSweep, ABeamThatLeavesSidewaysReadsTheNextRowOnlyWhereRowsWrap) {
  CorrelationGrid grid({0.05, 0.2, 1.0, 0.03});
  grid.reset({0, 0});
  const int middle = (grid.side_cells() - 1) / 2;
  // The end point of one row up, one whole stride to the left: reached by going right.
  const std::vector<Eigen::Vector2d> points = {{-0.9, 0.05}};
  grid.add_points(points);
  const Eigen::Vector2i cell = grid.cell_of(points.front());
  const std::int32_t right = cell.x() - middle + grid.stride();
  const std::vector<BeamOffset> offsets = {{right, right}};
  std::vector<std::uint32_t> sums;
  sweep_window(grid, offsets, {middle, middle, 1, 1}, EdgeRule::kWrap, sums);
  EXPECT_EQ(sums.front(), 100u);
  sweep_window(grid, offsets, {middle, middle, 1, 1}, EdgeRule::kStop, sums);
  EXPECT_EQ(sums.front(), 0u);
}

TEST(BeamOffsets, LeaveOutWhatHasNoPlace) {
  CorrelationGrid grid({0.05, 0.2, 1.0, 0.03});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Eigen::Vector2d> beams = {{nan, nan}, {0.5, 0.1}, {0, 1e9}, {1e12, 0}};
  std::vector<BeamOffset> offsets;
  fill_beam_offsets(beams, 0, grid, offsets);
  ASSERT_EQ(offsets.size(), 1u);
  EXPECT_EQ(offsets.front().column, 10);
  EXPECT_EQ(offsets.front().linear, 10 + 2 * grid.stride());
}

}  // namespace
}  // namespace corridor::karto
