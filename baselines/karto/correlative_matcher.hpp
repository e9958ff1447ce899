// Correlative scan-to-local-map matching in two stages, coarse and fine.
// [Konolige2010] section IV, [Olson2009]; as shipped by Karto. It answers for all poses of a fixed
// window, those that cannot be taken by a bound; it has no gradient.
#pragma once

#include <span>
#include <vector>

#include "baselines/karto/response_table.hpp"
#include "baselines/karto/scan_matcher.hpp"
#include "baselines/karto/search_part.hpp"

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

    [[nodiscard]] std::size_t num_poses() const {
      return static_cast<std::size_t>(heading_rad.count()) *
             static_cast<std::size_t>(position_m.count()) *
             static_cast<std::size_t>(position_m.count());
    }
  };

  [[nodiscard]] Stage coarse_stage(double half_width_rad) const;
  [[nodiscard]] Stage fine_stage() const;
  void select_beams(const KeyScan& scan);
  void share_out(const Stage& stage, bool use_threads);
  void draw(const Pose2& centre, const SearchAxis& heading_rad,
            std::span<const KeyScan* const> local_map);
  void want_cells(SearchPart& part, const HeadingRange& headings) const;
  [[nodiscard]] HeadingRange headings_of_part(std::size_t index, double centre_rad,
                                              const SearchAxis& heading_rad) const;
  [[nodiscard]] SearchPart& part_at(double offset_rad, const SearchAxis& heading_rad);
  template <class Body>
  void for_each_part(const Body& body);
  MatchResult coarse_search(const Pose2& centre, const MatchOptions& options);
  MatchResult search_coarse_once(const Pose2& centre, const Stage& stage,
                                 const MatchOptions& options);
  MatchResult refine(const Pose2& predicted, const MatchResult& coarse, bool use_penalty);
  [[nodiscard]] bool may_give_up(const MatchOptions& options) const;
  [[nodiscard]] std::uint32_t min_sum(const MatchOptions& options) const;
  void sweep_coarse(const Pose2& centre, const Stage& stage, std::uint32_t min_sum);
  [[nodiscard]] SweepWindow window_of(const Pose2& centre, const Stage& stage) const;
  [[nodiscard]] double best_unpenalised_response() const;
  [[nodiscard]] ResponseTable responses(const Stage& stage, bool use_penalty) const;
  void apply_penalty(ResponseTable& table) const;
  double variance_of_heading(SearchPart& part, const Pose2& centre, const SearchAxis& heading_rad,
                             const SearchOffset& best, double best_response);

  KartoParams params_;
  EdgeRule edge_rule_;
  GridSpec spec_;
  std::vector<SearchPart> parts_;  // the first num_parts_ are in use
  std::size_t num_parts_ = 1;
  PointColumns beams_sensor_m_;      // end points to look up
  double full_response_ = 1;         // sum that would be a response of 1
  std::vector<std::uint32_t> sums_;  // by heading, then by position
};

}  // namespace corridor::karto
