// Distance from a point to the nearest surface in a direction: what an ideal LiDAR beam measures.
// A uniform grid names the surfaces near each cell; the answer is that of testing every one.
// It adds no noise and no beam width.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "datasets/simulation/world.hpp"

namespace corridor::simulation {

class RayCaster {
 public:
  explicit RayCaster(const World& world);

  struct Hit {
    double range_m = 0;
    std::size_t surface_index = 0;  // as World counts them
  };

  // The nearest surface in min_m < range <= max_m; nullopt if there is none. Exact to rounding
  // (1e-9 m). At a corner that two surfaces share the one with the smaller index is named.
  [[nodiscard]] std::optional<Hit> cast(const Eigen::Vector2d& origin_m, double direction_rad,
                                        double max_m, double min_m = 0) const;
  [[nodiscard]] std::optional<double> range_m(const Eigen::Vector2d& origin_m, double direction_rad,
                                              double max_m) const;

 private:
  struct Ray;
  void fill_grid();
  template <class Visitor>
  void for_each_cell_of(std::size_t surface_index, Visitor&& visitor) const;
  void try_surface(const Ray& ray, std::uint32_t surface_index, std::optional<Hit>& nearest) const;
  void try_all(const Ray& ray, std::optional<Hit>& nearest) const;
  [[nodiscard]] std::span<const std::uint32_t> surfaces_of(int column, int row) const;

  std::vector<Segment> walls_;
  std::vector<Arc> arcs_;
  Eigen::Vector2d lower_m_ = Eigen::Vector2d::Zero();
  double cell_m_ = 1;
  int num_columns_ = 0;
  int num_rows_ = 0;
  std::vector<std::uint32_t>
      first_surface_;  // of each cell, into cell_surfaces_; one more than cells
  std::vector<std::uint32_t> cell_surfaces_;
};

}  // namespace corridor::simulation
