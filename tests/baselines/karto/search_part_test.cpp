// What a search may read has been asked for: read by read, not by the results that follow.
#include "baselines/karto/search_part.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "slam/core/rng.hpp"

namespace corridor::karto {
namespace {

// A search of the headings [first, end) of an axis, with beams of all lengths.
struct Search {
  explicit Search(Rng& rng)
      : spec{rng.uniform(0.01, 0.06), 0, rng.uniform(1, 5), 0},
        axis_rad{rng.uniform(0.05, 0.6), rng.uniform(0.01, 0.1)},
        turn_rad(axis_rad.step * rng.uniform(0.5, 0.7)),
        beams_m(40, 2) {
    spec.window_m = spec.resolution_m * rng.uniform(4, 60);
    spec.smear_m = spec.resolution_m * rng.uniform(0.5, 4);
    const auto count = static_cast<std::uint32_t>(axis_rad.count());
    const int a = static_cast<int>(rng.below(count));
    const int b = static_cast<int>(rng.below(count));
    headings = {rng.uniform(-3, 3), axis_rad, std::min(a, b), std::max(a, b) + 1};
    for (Eigen::Index i = 0; i < beams_m.rows(); ++i) {
      const double length_m =
          spec.reach_m * (rng.below(8) == 0 ? rng.uniform(1, 20) : rng.uniform(0, 1));
      const double angle_rad = rng.uniform(-3.2, 3.2);
      beams_m.row(i) << length_m * std::cos(angle_rad), length_m * std::sin(angle_rad);
    }
  }

  GridSpec spec;
  SearchAxis axis_rad;
  double turn_rad;
  HeadingRange headings;
  PointColumns beams_m;
};

// All cells whose stamp reaches a cell are wanted, in whatever row of the grid they lie.
bool is_wanted_around(const CorrelationGrid& grid, std::int64_t index) {
  const int reach = grid.smear_reach_cells();
  const int row = static_cast<int>(index / grid.stride());
  const int column = static_cast<int>(index % grid.stride());
  for (const int dy : {-reach, 0, reach}) {
    for (const int dx : {-reach, 0, reach}) {
      const Eigen::Vector2i cell(column + dx, row + dy);
      const bool is_in_grid = cell.x() >= 0 && cell.x() < grid.side_cells() && cell.y() >= 0 &&
                              cell.y() < grid.side_cells();
      const GridBlocks& blocks = grid.blocks();
      if (is_in_grid && !blocks.is_wanted(blocks.layout().block_of(cell.y(), cell.x())))
        return false;
    }
  }
  return true;
}

// A fine search is centred within half a step of a heading of the part, not beyond the axis, and
// turns by up to turn_rad; it moves a cell beyond the lattice.
RC_GTEST_PROP(SearchPart, WantsWhateverAFineSearchNearItsHeadingsReads, (std::uint64_t seed)) {
  Rng rng(seed);
  const Search search(rng);
  SearchPart part(search.spec);
  part.reset({rng.uniform(-5, 5), rng.uniform(-5, 5)});
  part.aim(search.beams_m, search.headings);
  part.want_around(search.beams_m, search.headings, search.turn_rad);
  const CorrelationGrid& grid = part.grid();
  const HeadingRange& headings = search.headings;
  const double half_step_rad = 0.5 * search.axis_rad.step;
  const double lowest_rad = std::max(headings.at(headings.first) - half_step_rad, headings.at(0));
  const double highest_rad = std::min(headings.at(headings.end - 1) + half_step_rad,
                                      headings.at(search.axis_rad.count() - 1));
  const double half_window_cells = 0.5 * search.spec.window_m / search.spec.resolution_m;
  const int farthest = static_cast<int>(half_window_cells + 1.5) + 2;
  std::vector<BeamOffset> offsets;
  for (int look = 0; look < 20; ++look) {
    const double heading_rad =
        rng.uniform(lowest_rad, highest_rad) + rng.uniform(-search.turn_rad, search.turn_rad);
    fill_beam_offsets(search.beams_m, heading_rad, grid, offsets);
    for (const BeamOffset& offset : offsets) {
      const int dx = static_cast<int>(rng.below(3)) - 1;
      const int dy = static_cast<int>(rng.below(3)) - 1;
      const std::int64_t position =
          grid.middle_cell() + dx * farthest +
          std::int64_t{grid.middle_cell() + dy * farthest} * grid.stride();
      const std::int64_t index = position + offset.linear;
      if (index < 0 || index >= grid.num_cells()) continue;
      RC_ASSERT(is_wanted_around(grid, index));
    }
  }
}

// Otherwise the property above would hold for a part that wants everything.
TEST(SearchPart, DoesNotWantWhatNoHeadingLeadsTo) {
  const GridSpec spec{0.01, 0.3, 5, 0.03};
  const SearchAxis axis_rad{0.349, 0.0349};
  PointColumns beams(1, 2);
  beams << 4, 0;
  SearchPart part(spec);
  part.reset({0, 0});
  const HeadingRange first_half{0, axis_rad, 0, 10};
  part.aim(beams, first_half);
  part.want_around(beams, first_half, 0.0175);
  const GridBlocks& blocks = part.grid().blocks();
  const auto is_wanted = [&](double x_m, double y_m) {
    const Eigen::Vector2i cell = part.grid().cell_of({x_m, y_m});
    return blocks.is_wanted(blocks.layout().block_of(cell.y(), cell.x()));
  };
  EXPECT_TRUE(is_wanted(4 * std::cos(-0.2), 4 * std::sin(-0.2)));
  EXPECT_FALSE(is_wanted(4 * std::cos(0.3), 4 * std::sin(0.3)));
  EXPECT_FALSE(is_wanted(2, 0));
}

}  // namespace
}  // namespace corridor::karto
