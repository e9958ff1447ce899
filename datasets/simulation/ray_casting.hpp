// Distance from a point to the nearest wall in a direction: what an ideal LiDAR beam measures.
// A uniform grid names the walls near each cell; the answer is that of testing every wall.
// It adds no noise and no beam width.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "datasets/simulation/world.hpp"

namespace corridor::simulation {

// Distance along the ray origin + t * (cos, sin)(direction) to a wall, if it meets it at t > 0.
// A ray parallel to the wall misses it.
std::optional<double> distance_to_wall_m(const Segment& wall, const Eigen::Vector2d& origin_m,
                                         const Eigen::Vector2d& unit_direction);

class RayCaster {
 public:
  explicit RayCaster(const World& world);

  struct Hit {
    double range_m = 0;
    std::size_t wall_index = 0;  // into World::walls
  };

  // The nearest wall in 0 < range <= max_m; nullopt if there is none. Exact to rounding (1e-9 m).
  // At a corner that two walls share the one with the smaller index is named.
  [[nodiscard]] std::optional<Hit> cast(const Eigen::Vector2d& origin_m, double direction_rad,
                                        double max_m) const;
  [[nodiscard]] std::optional<double> range_m(const Eigen::Vector2d& origin_m, double direction_rad,
                                              double max_m) const;

 private:
  void append_walls_of(const Eigen::Vector2d& cell_centre_m);
  [[nodiscard]] std::span<const std::uint32_t> walls_of(int column, int row) const;

  std::vector<Segment> walls_;
  Eigen::Vector2d lower_m_ = Eigen::Vector2d::Zero();
  int num_columns_ = 0;
  int num_rows_ = 0;
  std::vector<std::uint32_t> first_wall_;  // of each cell, into cell_walls_; one more than cells
  std::vector<std::uint32_t> cell_walls_;
};

}  // namespace corridor::simulation
