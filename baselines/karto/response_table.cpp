#include "baselines/karto/response_table.hpp"

#include <algorithm>
#include <cmath>

namespace corridor::karto {
namespace {

constexpr double kTolerance = 1e-6;            // two responses are equal within it
constexpr double kVarianceFloor_steps2 = 0.1;  // of one step of the search, squared
constexpr double kUnknownVariance_m2 = 500;

// By y, then by x; at least 0.
Eigen::ArrayXd best_over_headings(const ResponseTable& table) {
  Eigen::ArrayXd best = Eigen::ArrayXd::Zero(table.num_positions() * table.num_positions());
  for (int heading = 0; heading < table.num_headings(); ++heading) {
    best = best.max(table.of_heading(heading));
  }
  return best;
}

}  // namespace

int SearchAxis::count() const { return static_cast<int>(std::lround(2 * half_width / step)) + 1; }

ResponseTable::ResponseTable(const SearchAxis& position_m, const SearchAxis& heading_rad)
    : position_m_(position_m),
      heading_rad_(heading_rad),
      num_positions_(position_m.count()),
      num_headings_(heading_rad.count()),
      responses_(static_cast<std::size_t>(num_headings_) *
                 static_cast<std::size_t>(num_positions_) *
                 static_cast<std::size_t>(num_positions_)) {}

double ResponseTable::best_response() const {
  return Eigen::Map<const Eigen::ArrayXd>(responses_.data(),
                                          static_cast<Eigen::Index>(responses_.size()))
      .maxCoeff();
}

SearchOffset mean_best_offset(const ResponseTable& table, double best_response) {
  Eigen::Vector2d position_sum_m = Eigen::Vector2d::Zero();
  double cos_sum = 0;
  double sin_sum = 0;
  int count = 0;
  for (int heading = 0; heading < table.num_headings(); ++heading) {
    if (table.of_heading(heading).maxCoeff() < best_response - kTolerance) continue;
    const double heading_rad = table.heading_rad().offset(heading);
    for (int y = 0; y < table.num_positions(); ++y) {
      for (int x = 0; x < table.num_positions(); ++x) {
        if (table.at(heading, y, x) < best_response - kTolerance) continue;
        position_sum_m +=
            Eigen::Vector2d(table.position_m().offset(x), table.position_m().offset(y));
        cos_sum += std::cos(heading_rad);
        sin_sum += std::sin(heading_rad);
        ++count;
      }
    }
  }
  return {position_sum_m / count, std::atan2(sin_sum / count, cos_sum / count)};
}

Eigen::Matrix2d positional_covariance(const ResponseTable& table, double best_response,
                                      const SearchOffset& best) {
  if (best_response < kTolerance) return kUnknownVariance_m2 * Eigen::Matrix2d::Identity();
  const Eigen::ArrayXd best_responses = best_over_headings(table);
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  double weight_sum = 0;
  for (int y = 0; y < table.num_positions(); ++y) {
    for (int x = 0; x < table.num_positions(); ++x) {
      const double response = best_responses[y * table.num_positions() + x];
      if (response < best_response - kResponseMargin) continue;
      const Eigen::Vector2d from_best_m =
          Eigen::Vector2d(table.position_m().offset(x), table.position_m().offset(y)) -
          best.position_m;
      moments += response * from_best_m * from_best_m.transpose();
      weight_sum += response;
    }
  }
  if (weight_sum < kTolerance) return kUnknownVariance_m2 * Eigen::Matrix2d::Identity();
  moments /= weight_sum;
  const double step_m = table.position_m().step;
  const double floor_m2 = kVarianceFloor_steps2 * step_m * step_m;
  moments.diagonal() = moments.diagonal().cwiseMax(floor_m2);
  return moments / best_response;
}

double heading_variance(const std::vector<double>& responses, const SearchAxis& heading_rad,
                        double best_response, double best_heading_rad, double fallback_rad2) {
  double weighted_rad2 = 0;
  double weight_sum = 0;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    if (responses[i] < best_response - kResponseMargin) continue;
    const double difference_rad = heading_rad.offset(static_cast<int>(i)) - best_heading_rad;
    weighted_rad2 += responses[i] * difference_rad * difference_rad;
    weight_sum += responses[i];
  }
  if (weight_sum < kTolerance) return fallback_rad2;
  if (weighted_rad2 < kTolerance) weighted_rad2 = heading_rad.step * heading_rad.step;
  return weighted_rad2 / weight_sum;
}

}  // namespace corridor::karto
