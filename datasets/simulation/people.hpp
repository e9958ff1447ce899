// People who walk up and down a route while the robot drives.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "datasets/simulation/scenario_params.hpp"
#include "slam/core/rng.hpp"

namespace corridor::simulation {

// As a LiDAR sees one at a moment: a disc.
struct Person {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double radius_m = 0;
};

// Distance along the ray to a person's disc, from outside.
std::optional<double> distance_to_m(const Person& person, const Eigen::Vector2d& origin_m,
                                    const Eigen::Vector2d& unit_direction);

class People {
 public:
  // Draws where each begins, how fast and how far beside the route. Requires a route of two points
  // or more where there are people.
  People(const PeopleParams& params, std::vector<Eigen::Vector2d> route_m, Rng rng);

  // At a time since the begin; who would stand closer to the robot than an arm's length is moved
  // away from it.
  [[nodiscard]] std::vector<Person> at(double time_s, const Eigen::Vector2d& robot_m) const;

 private:
  struct Walk {
    double begin_m, speed_mps, offset_m;
  };
  [[nodiscard]] Eigen::Vector2d point_m(const Walk& walk, double time_s) const;

  double radius_m_;
  std::vector<Eigen::Vector2d> route_m_;
  double length_m_ = 0;
  std::vector<Walk> walks_;
};

}  // namespace corridor::simulation
