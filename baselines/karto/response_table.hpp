// Responses of all poses of one search, and what follows from them: the best pose and its
// covariance. [Olson2009] section IV, as [Konolige2010] ships it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "slam/core/pose2.hpp"

namespace corridor::karto {

// One axis of a search: offsets -half_width, -half_width + step, ... relative to the search's
// centre.
struct SearchAxis {
  double half_width = 0;
  double step = 1;

  // round(2 * half_width / step) + 1
  [[nodiscard]] int count() const;
  [[nodiscard]] double offset(int index) const { return -half_width + index * step; }
};

// x and y along the map's axes, share one SearchAxis; heading has its own.
class ResponseTable {
 public:
  // All responses are 0.
  ResponseTable(const SearchAxis& position_m, const SearchAxis& heading_rad);

  [[nodiscard]] const SearchAxis& position_m() const { return position_m_; }
  [[nodiscard]] const SearchAxis& heading_rad() const { return heading_rad_; }
  [[nodiscard]] int num_positions() const { return num_positions_; }
  [[nodiscard]] int num_headings() const { return num_headings_; }

  [[nodiscard]] double& at(int heading, int y, int x) { return responses_[index(heading, y, x)]; }
  [[nodiscard]] double at(int heading, int y, int x) const {
    return responses_[index(heading, y, x)];
  }
  // All of them: by heading, then by y, then by x.
  [[nodiscard]] std::span<double> responses() { return responses_; }
  // Of one heading, by y, then by x.
  using Slice = Eigen::Map<const Eigen::ArrayXd>;
  [[nodiscard]] Slice of_heading(int heading) const {
    return {responses_.data() + index(heading, 0, 0), num_positions_ * num_positions_};
  }

  [[nodiscard]] double best_response() const;

 private:
  [[nodiscard]] std::size_t index(int heading, int y, int x) const {
    return (static_cast<std::size_t>(heading) * static_cast<std::size_t>(num_positions_) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(num_positions_) +
           static_cast<std::size_t>(x);
  }

  SearchAxis position_m_;
  SearchAxis heading_rad_;
  int num_positions_;
  int num_headings_;
  std::vector<double> responses_;
};

// Offset of a pose from the centre of a search, along the map's axes.
struct SearchOffset {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
};

// Mean of all offsets whose response is the best within 1e-6; circular mean for the heading.
SearchOffset mean_best_offset(const ResponseTable& table, double best_response);

// Poses this close to the best response shape the covariance.
inline constexpr double kResponseMargin = 0.1;

// 2x2 [m^2], order (x, y) of the map, around `best`: each position counts with its best response
// over the headings if that is within kResponseMargin of the best one, weight = response; variances
// at least 0.1 * step^2; all divided by the best response. 500 m^2 on the diagonal if nothing
// responds.
Eigen::Matrix2d positional_covariance(const ResponseTable& table, double best_response,
                                      const SearchOffset& best);

// Variance [rad^2] of the heading from the responses at the best position, one per heading offset:
// sum r (a - best)^2 / sum r over responses within kResponseMargin of the best; a sum below 1e-6 is
// replaced by step^2 first. `fallback_rad2` if nothing responds.
double heading_variance(const std::vector<double>& responses, const SearchAxis& heading_rad,
                        double best_response, double best_heading_rad, double fallback_rad2);

}  // namespace corridor::karto
