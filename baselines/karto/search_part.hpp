// One thread's share of a correlative search: some of its headings, and a grid of its own to look
// them up in. Two threads that write and read one grid lose more than it costs to draw it twice.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "baselines/karto/correlation_grid.hpp"
#include "baselines/karto/key_scan.hpp"
#include "baselines/karto/response_table.hpp"
#include "baselines/karto/window_sweep.hpp"

namespace corridor::karto {

// Headings [first, end) of an axis around a centre.
struct HeadingRange {
  double centre_rad = 0;
  SearchAxis axis_rad;
  int first = 0;
  int end = 0;

  static HeadingRange all(double centre_rad, const SearchAxis& axis_rad) {
    return {centre_rad, axis_rad, 0, axis_rad.count()};
  }
  [[nodiscard]] int count() const { return end - first; }
  [[nodiscard]] double at(int index) const { return centre_rad + axis_rad.offset(index); }
};

// To be called in this order: reset, aim, one of the two want, find, draw, sweep; then aim
// and sweep as often as wanted.
class SearchPart {
 public:
  explicit SearchPart(const GridSpec& spec);

  [[nodiscard]] const CorrelationGrid& grid() const { return grid_; }
  // Empties the grid and moves its middle.
  void reset(const Eigen::Vector2d& middle_map_m);
  // Takes headings on, with the beams' end points there.
  void aim(const PointColumns& beams_sensor_m, const HeadingRange& headings);
  [[nodiscard]] int num_headings() const { return static_cast<int>(num_headings_); }
  // What is going to be read lies around the beams at the headings aimed at, at their neighbours
  // on the axis, and up to `turn_rad` from each.
  void want_around(const PointColumns& beams_sensor_m, const HeadingRange& headings,
                   double turn_rad);
  void want_all() { grid_.blocks().want_all(); }
  // Finds the cells of end points that any part of the search may read, of surfaces that face the
  // grid's middle.
  void find(std::span<const KeyScan* const> local_map, std::span<const SearchPart> parts);
  // Draws what a part of the search, or this one, has found.
  void draw(const SearchPart& finder);
  // As window_sweep.hpp says; `sums` by heading, then by position.
  void sweep(const SweepWindow& window, EdgeRule edge_rule, std::uint32_t min_sum,
             std::span<std::uint32_t> sums);

 private:
  void find_of_scan(const KeyScan& scan);
  void want(const std::vector<BeamOffset>& offsets);
  void want_far_beams(const PointColumns& beams_sensor_m, const HeadingRange& headings,
                      double turn_rad);

  CorrelationGrid grid_;
  Eigen::Vector2d middle_map_m_ = Eigen::Vector2d::Zero();
  // Of the points of one scan.
  GridCells cells_;
  std::vector<std::uint8_t> is_facing_;
  std::vector<std::uint8_t> wanted_by_any_;  // by block
  GridCells found_;                          // the first num_found_ are in use
  std::size_t num_found_ = 0;
  std::vector<BeamOffset> offsets_;     // of a heading that is not searched
  std::vector<HeadingSweep> headings_;  // the first num_headings_ are in use
  std::size_t num_headings_ = 0;
};

}  // namespace corridor::karto
