#include "datasets/simulation/scenario_params.hpp"

#include <fmt/format.h>

#include <numbers>

namespace corridor::simulation {

WorldParams to_params(const CorridorShape& shape) {
  return {shape.a_m, shape.b_m, shape.c_m, shape.alpha_rad / (std::numbers::pi / 180),
          shape.doors_every_m};
}

CorridorShape to_shape(const WorldParams& params) {
  return {params.a_m, params.b_m, params.c_m, params.alpha_deg * (std::numbers::pi / 180),
          params.doors_every_m};
}

std::vector<std::string> LidarParams::relations() const {
  if (range_min_m < range_max_m) return {};
  return {fmt::format("range_min_m = {}: expected less than range_max_m = {}", range_min_m,
                      range_max_m)};
}

std::vector<std::string> DriveParams::relations() const {
  if (speed_min_mps <= speed_max_mps) return {};
  return {fmt::format("speed_min_mps = {}: expected at most speed_max_mps = {}", speed_min_mps,
                      speed_max_mps)};
}

}  // namespace corridor::simulation
