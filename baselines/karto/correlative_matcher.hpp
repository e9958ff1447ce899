// Correlative scan-to-local-map matching in two stages, coarse and fine.
// [Konolige2010] section IV, [Olson2009]; as shipped by Karto. It searches a fixed window of poses,
// all of them; it has no gradient.
#pragma once

#include <span>
#include <vector>

#include "baselines/karto/response_table.hpp"
#include "baselines/karto/scan_matcher.hpp"
#include "baselines/karto/window_sweep.hpp"

namespace corridor::karto {

class CorrelativeMatcher {
 public:
  CorrelativeMatcher(const GridSpec& spec, const KartoParams& params);

  // As ScanMatcher says.
  MatchResult match(const KeyScan& scan, const Pose2& T_map_sensor_predicted,
                    std::span<const KeyScan* const> local_map, const MatchOptions& options);

 private:
  struct Stage {
    SearchAxis position_m;
    SearchAxis heading_rad;
    int step_cells;
  };

  [[nodiscard]] Stage coarse_stage(double half_width_rad) const;
  [[nodiscard]] Stage fine_stage() const;
  void select_beams(const KeyScan& scan, std::size_t stride);
  void aim(double centre_rad, const SearchAxis& heading_rad);
  void want_cells_around_beams(double centre_rad, const SearchAxis& heading_rad);
  void want_cells_of_far_beams(double centre_rad, const SearchAxis& heading_rad);
  void want(const std::vector<BeamOffset>& offsets);
  void draw_local_map(const Eigen::Vector2d& viewpoint_m,
                      std::span<const KeyScan* const> local_map);
  MatchResult coarse_search(const Pose2& centre, const MatchOptions& options);
  MatchResult search_coarse_once(const Pose2& centre, const Stage& stage,
                                 const MatchOptions& options);
  MatchResult refine(const MatchResult& coarse, bool use_penalty);
  [[nodiscard]] bool may_give_up(const MatchOptions& options) const;
  [[nodiscard]] std::uint32_t min_sum(const MatchOptions& options) const;
  void sweep(const SweepWindow& window, std::uint32_t min_sum);
  void sweep_stage(const Pose2& centre, const Stage& stage, std::uint32_t min_sum);
  [[nodiscard]] double best_unpenalised_response() const;
  [[nodiscard]] ResponseTable responses(const Stage& stage, bool use_penalty) const;
  void apply_penalty(ResponseTable& table) const;
  double variance_of_heading(const Pose2& centre, const SearchAxis& heading_rad,
                             const SearchOffset& best, double best_response);

  KartoParams params_;
  double window_m_;
  EdgeRule edge_rule_;
  CorrelationGrid grid_;
  GridCells cells_;                     // of the points of one scan
  PointColumns beams_sensor_m_;         // end points to look up
  double full_response_ = 1;            // sum that would be a response of 1
  std::vector<HeadingSweep> headings_;  // the first num_headings_ are in use
  std::size_t num_headings_ = 0;
  std::vector<std::uint32_t> sums_;  // by heading, then by position
};

}  // namespace corridor::karto
