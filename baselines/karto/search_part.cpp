#include "baselines/karto/search_part.hpp"

#include <algorithm>
#include <cmath>

#include "slam/core/expect.hpp"

namespace corridor::karto {
namespace {

// Cells by which an end point may lie beside that of the nearest heading, since the fine search
// tries what is in between: at 1 cm, half a step of 2 deg at 12.6 m.
constexpr int kTurnMargin_cells = 22;
// Cells by which the search leaves its window: the lattice ends one beyond, the fine search goes
// one farther, centre and lattice are rounded.
constexpr int kLatticeMargin_cells = 4;
// A search of which more headings would have to be looked at may read anywhere.
constexpr double kMaxFarHeadings = 2000;

int read_margin_cells(const GridSpec& spec) {
  const double half_window_cells = std::ceil(0.5 * spec.window_m / spec.resolution_m);
  return static_cast<int>(half_window_cells) + kLatticeMargin_cells + kTurnMargin_cells;
}

}  // namespace

SearchPart::SearchPart(const GridSpec& spec) : grid_(spec, read_margin_cells(spec)) {}

void SearchPart::reset(const Eigen::Vector2d& middle_map_m) {
  middle_map_m_ = middle_map_m;
  grid_.reset(middle_map_m);
}

void SearchPart::aim(const PointColumns& beams_sensor_m, const HeadingRange& headings) {
  num_headings_ = static_cast<std::size_t>(headings.count());
  if (headings_.size() < num_headings_) headings_.resize(num_headings_);
  for (int i = 0; i < headings.count(); ++i) {
    fill_beam_offsets(beams_sensor_m, headings.at(headings.first + i), grid_,
                      headings_[static_cast<std::size_t>(i)].offsets);
  }
}

// The neighbours: a best heading between two parts of a search is looked at by one of them.
void SearchPart::want_around(const PointColumns& beams_sensor_m, const HeadingRange& headings,
                             double turn_rad) {
  for (std::size_t i = 0; i < num_headings_; ++i) want(headings_[i].offsets);
  HeadingRange wanted = headings;
  if (headings.first > 0) {
    fill_beam_offsets(beams_sensor_m, headings.at(--wanted.first), grid_, offsets_);
    want(offsets_);
  }
  if (headings.end < headings.axis_rad.count()) {
    fill_beam_offsets(beams_sensor_m, headings.at(wanted.end++), grid_, offsets_);
    want(offsets_);
  }
  want_far_beams(beams_sensor_m, wanted, turn_rad);
  grid_.blocks().add_margin();
}

// Beams so long that the margin does not cover what lies between two headings, or beyond the last;
// they have no return, but rows that wrap lead them back into the grid. Headings as close as they
// need.
void SearchPart::want_far_beams(const PointColumns& beams_sensor_m, const HeadingRange& headings,
                                double turn_rad) {
  const double margin_m = kTurnMargin_cells * grid_.resolution_m();
  PointColumns far_beams_m(beams_sensor_m.rows(), 2);
  Eigen::Index num_far = 0;
  double longest_m = 0;
  for (Eigen::Index i = 0; i < beams_sensor_m.rows(); ++i) {
    const double length_m = beams_sensor_m.row(i).norm();
    if (length_m <= margin_m / turn_rad) continue;
    far_beams_m.row(num_far++) = beams_sensor_m.row(i);
    longest_m = std::max(longest_m, length_m);
  }
  if (num_far == 0) return;
  far_beams_m.conservativeResize(num_far, 2);
  const double first_rad = headings.at(headings.first) - turn_rad;
  const double range_rad = headings.at(headings.end - 1) + turn_rad - first_rad;
  const double num_looks = std::ceil(range_rad * longest_m / (2 * margin_m));
  if (num_looks > kMaxFarHeadings) return want_all();
  for (double i = 0.5; i < num_looks; ++i) {
    fill_beam_offsets(far_beams_m, first_rad + range_rad * i / num_looks, grid_, offsets_);
    want(offsets_);
  }
}

void SearchPart::want(const std::vector<BeamOffset>& offsets) {
  const int middle = grid_.middle_cell();
  for (const BeamOffset& offset : offsets) {
    grid_.blocks().want(middle + offset.row, middle + offset.column);
  }
}

void SearchPart::find(std::span<const KeyScan* const> local_map,
                      std::span<const SearchPart> parts) {
  wanted_by_any_ = parts.front().grid_.blocks().wanted();
  for (const SearchPart& part : parts.subspan(1)) {
    const std::vector<std::uint8_t>& wanted = part.grid_.blocks().wanted();
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted_by_any_[i] |= wanted[i];
  }
  num_found_ = 0;
  for (const KeyScan* scan : local_map) find_of_scan(*scan);
}

// Every cell is written, and the next one over it if it is not to be kept: without branches.
void SearchPart::find_of_scan(const KeyScan& scan) {
  grid_.find_cells(scan.points_map_m(), cells_);
  scan.surface_map().find_facing(middle_map_m_, is_facing_);
  const std::vector<std::uint32_t>& piece_of_point = scan.surface_map().piece_of_point();
  const std::size_t num_cells = cells_.index.size();
  if (found_.index.size() < num_found_ + num_cells) found_.resize(2 * (num_found_ + num_cells));
  std::int32_t* const index = found_.index.data() + num_found_;
  std::int32_t* const block = found_.block.data() + num_found_;
  const std::uint8_t* const is_wanted = wanted_by_any_.data();
  const std::uint8_t* const is_facing = is_facing_.data();
  std::size_t count = 0;
  for (std::size_t i = 0; i < num_cells; ++i) {
    index[count] = cells_.index[i];
    block[count] = cells_.block[i];
    count += is_wanted[cells_.block[i]] & is_facing[piece_of_point[i]];
  }
  num_found_ += count;
}

void SearchPart::draw(const SearchPart& finder) { grid_.occupy(finder.found_, finder.num_found_); }

void SearchPart::sweep(const SweepWindow& window, EdgeRule edge_rule, std::uint32_t min_sum,
                       std::span<std::uint32_t> sums) {
  const std::size_t num_positions = window.num_positions();
  CORRIDOR_EXPECT(sums.size() == num_headings_ * num_positions);
  const std::span<HeadingSweep> headings = std::span(headings_).first(num_headings_);
  for (std::size_t i = 0; i < num_headings_; ++i) {
    headings[i].sums = sums.subspan(i * num_positions, num_positions);
  }
  sweep_window(grid_, window, edge_rule, min_sum, headings);
}

}  // namespace corridor::karto
