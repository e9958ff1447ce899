#include "datasets/simulation/people.hpp"

#include <cmath>

#include "datasets/simulation/surfaces.hpp"
#include "slam/core/expect.hpp"

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kArmsLength_m = 0.7;

}  // namespace

std::optional<double> distance_to_m(const Person& person, const Vector2d& origin_m,
                                    const Vector2d& unit_direction) {
  return distance_to_m(Arc{.centre_m = person.centre_m, .radius_m = person.radius_m}, origin_m,
                       unit_direction);
}

People::People(const PeopleParams& params, std::vector<Vector2d> route_m, Rng rng)
    : radius_m_(params.radius_m), route_m_(std::move(route_m)) {
  CORRIDOR_EXPECT(params.num_people == 0 || route_m_.size() >= 2);
  for (std::size_t i = 0; i + 1 < route_m_.size(); ++i) {
    length_m_ += (route_m_[i + 1] - route_m_[i]).norm();
  }
  for (int i = 0; i < params.num_people; ++i) {
    Rng own = rng.stream(static_cast<std::uint64_t>(i));
    Walk walk{};
    walk.begin_m = own.uniform(0, 2 * length_m_);
    walk.speed_mps = own.uniform(params.speed_min_mps, params.speed_max_mps);
    walk.offset_m = own.uniform(-params.lateral_spread_m, params.lateral_spread_m);
    walks_.push_back(walk);
  }
}

// Up the route and down again: the second half of 2 * length is the way back.
Vector2d People::point_m(const Walk& walk, double time_s) const {
  const double walked_m = std::fmod(walk.begin_m + walk.speed_mps * time_s, 2 * length_m_);
  double along_m = walked_m <= length_m_ ? walked_m : 2 * length_m_ - walked_m;
  std::size_t leg = 0;
  while (leg + 2 < route_m_.size()) {
    const double leg_m = (route_m_[leg + 1] - route_m_[leg]).norm();
    if (along_m <= leg_m) break;
    along_m -= leg_m;
    ++leg;
  }
  const Vector2d direction = (route_m_[leg + 1] - route_m_[leg]).normalized();
  return route_m_[leg] + along_m * direction +
         walk.offset_m * Vector2d(-direction.y(), direction.x());
}

std::vector<Person> People::at(double time_s, const Vector2d& robot_m) const {
  std::vector<Person> people;
  for (const Walk& walk : walks_) {
    Vector2d centre_m = point_m(walk, time_s);
    const Vector2d from_robot = centre_m - robot_m;
    const double least_m = kArmsLength_m + radius_m_;
    if (from_robot.norm() < least_m) {
      const Vector2d away = from_robot.norm() > 0 ? from_robot.normalized() : Vector2d(0, 1);
      centre_m = robot_m + least_m * away;
    }
    people.push_back({centre_m, radius_m_});
  }
  return people;
}

}  // namespace corridor::simulation
