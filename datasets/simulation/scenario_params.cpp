#include "datasets/simulation/scenario_params.hpp"

#include <fmt/format.h>

#include "slam/core/units.hpp"

namespace corridor::simulation {

WorldParams to_params(const CorridorShape& shape) {
  return {shape.a_m, shape.b_m, shape.c_m, shape.alpha_rad / kRadPerDeg, shape.doors_every_m};
}

CorridorShape to_shape(const WorldParams& params) {
  return {params.a_m, params.b_m, params.c_m, params.alpha_deg * kRadPerDeg, params.doors_every_m};
}

std::vector<std::string> DriveParams::relations() const {
  if (speed_min_mps <= speed_max_mps) return {};
  return {fmt::format("speed_min_mps = {}: expected at most speed_max_mps = {}", speed_min_mps,
                      speed_max_mps)};
}

std::vector<std::string> SlipParams::relations() const {
  if (num_slips == 0 || share == 0) return {};
  return {fmt::format("num_slips = {}: expected 0 beside share = {}", num_slips, share)};
}

std::vector<std::string> PeopleParams::relations() const {
  if (speed_min_mps <= speed_max_mps) return {};
  return {fmt::format("speed_min_mps = {}: expected at most speed_max_mps = {}", speed_min_mps,
                      speed_max_mps)};
}

}  // namespace corridor::simulation
