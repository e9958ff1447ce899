#include "datasets/simulation/map_borders.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

// Runs of so many cells on both sides make a corner that no slanted wall has: of the two directions
// of its staircase one goes cell by cell.
constexpr int kStraightRun_cells = 3;
// Thin rings without such corners become one line, shorter ones stay.
constexpr double kSmallThing_cells = 6;
// Halving a line at its farthest corner is not bound to end soon; below this many halvings it is
// halved in the middle, so that any map takes n log n.
constexpr int kMaxFarthest = 64;

class BorderTracer {
 public:
  explicit BorderTracer(const GridMap& map)
      : map_(map),
        is_traced_(static_cast<std::size_t>(map.num_columns() + 1) *
                   static_cast<std::size_t>(map.num_rows() + 1)) {}

  std::vector<Ring> trace() {
    std::vector<Ring> rings;
    for (int row = 0; row <= map_.num_rows(); ++row) {
      for (int column = 0; column <= map_.num_columns(); ++column) {
        // Every ring goes along +x somewhere.
        const Vector2i corner(column, row);
        if (is_border(corner, kAlongX) && !is_traced_[index(corner)]) {
          rings.push_back(ring_from(corner));
        }
      }
    }
    return rings;
  }

 private:
  static constexpr int kAlongX = 0;  // headings go on counter-clockwise

  [[nodiscard]] std::size_t index(const Vector2i& corner) const {
    return static_cast<std::size_t>(corner.y()) * static_cast<std::size_t>(map_.num_columns() + 1) +
           static_cast<std::size_t>(corner.x());
  }

  [[nodiscard]] bool is_occupied(int column, int row) const {
    return map_.contains(column, row) && map_.at(column, row).is_observed &&
           map_.at(column, row).log_odds > 0;
  }

  // The cell to the left of a heading from a corner.
  [[nodiscard]] bool is_left_occupied(const Vector2i& corner, int heading) const {
    constexpr std::array<std::array<int, 2>, 4> kCell{{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
    const auto& [column, row] = kCell[static_cast<std::size_t>(heading)];
    return is_occupied(corner.x() + column, corner.y() + row);
  }

  [[nodiscard]] bool is_border(const Vector2i& corner, int heading) const {
    return is_left_occupied(corner, heading) && !is_left_occupied(corner, (heading + 3) % 4);
  }

  // The rightmost border that goes on: where four cells meet crosswise, to the occupied one across.
  [[nodiscard]] int next_heading(const Vector2i& corner, int heading) const {
    for (const int turn : {3, 0}) {
      if (is_border(corner, (heading + turn) % 4)) return (heading + turn) % 4;
    }
    return (heading + 1) % 4;
  }

  // `begin` is where a run along +x begins, since those are looked for from left to right.
  Ring ring_from(const Vector2i& begin) {
    constexpr std::array<std::array<int, 2>, 4> kStep{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    Ring ring;
    Vector2i corner = begin;
    int heading = kAlongX;
    do {
      if (heading == kAlongX) is_traced_[index(corner)] = true;
      const auto& [x, y] = kStep[static_cast<std::size_t>(heading)];
      corner += Vector2i(x, y);
      const int next = next_heading(corner, heading);
      if (next != heading) ring.push_back(corner);
      heading = next;
    } while (corner != begin || heading != kAlongX);
    return ring;
  }

  const GridMap& map_;
  std::vector<bool> is_traced_;  // per corner: the border from it along +x
};

double distance(const Vector2i& point, const Vector2i& a, const Vector2i& b) {
  const Vector2d along = (b - a).cast<double>();
  const Vector2d offset = (point - a).cast<double>();
  const double square = along.squaredNorm();
  if (square == 0) return offset.norm();
  return (offset - std::clamp(offset.dot(along) / square, 0.0, 1.0) * along).norm();
}

class Straightener {
 public:
  explicit Straightener(const Ring& ring)
      : ring_(ring), size_(ring.size()), is_kept_(ring.size()) {}

  Ring straighten() {
    keep_corners();
    std::vector<std::size_t> ends;
    for (std::size_t i = 0; i < size_; ++i) {
      if (is_kept_[i]) ends.push_back(i);
    }
    if (ends.size() < 2) {
      const std::size_t one = ends.empty() ? farthest_from(0) : ends.front();
      const std::size_t other = farthest_from(one);
      is_kept_[one] = is_kept_[other] = true;
      ends = {std::min(one, other), std::max(one, other)};
    }
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) keep_between(ends[k], ends[k + 1]);
    keep_between(ends.back(), ends.front() + size_);
    return kept();
  }

 private:
  // Indices go round.
  [[nodiscard]] const Vector2i& at(std::size_t i) const { return ring_[i % size_]; }
  [[nodiscard]] Vector2i run(std::size_t i) const { return at(i + 1) - at(i); }
  [[nodiscard]] bool is_straight_run(std::size_t i) const {
    return run(i).lpNorm<1>() >= kStraightRun_cells;
  }
  [[nodiscard]] bool is_left_turn(std::size_t i) const {
    const Vector2i before = run(i + size_ - 1);
    const Vector2i after = run(i);
    return std::int64_t{before.x()} * after.y() - std::int64_t{before.y()} * after.x() > 0;
  }

  // Corners between straight runs, and both ends of a run across the end of a thin wall.
  void keep_corners() {
    for (std::size_t i = 0; i < size_; ++i) {
      if (!is_straight_run(i + size_ - 1)) continue;
      if (is_straight_run(i)) is_kept_[i] = true;
      if (is_straight_run(i + 1) && is_left_turn(i) == is_left_turn(i + 1)) {
        is_kept_[i] = is_kept_[(i + 1) % size_] = true;
      }
    }
  }

  [[nodiscard]] std::size_t farthest_from(std::size_t from) const {
    std::size_t farthest = from;
    for (std::size_t i = 0; i < size_; ++i) {
      if (distance(at(i), at(from), at(from)) > distance(at(farthest), at(from), at(from))) {
        farthest = i;
      }
    }
    return farthest;
  }

  void keep_between(std::size_t first, std::size_t last) {
    struct Part {
      std::size_t begin, end;
      int num_halvings;
    };
    std::vector<Part> parts{{first, last, 0}};
    while (!parts.empty()) {
      const Part part = parts.back();
      parts.pop_back();
      std::size_t farthest = part.begin;
      double most_cells = kStraightWithin_cells;
      for (std::size_t i = part.begin + 1; i < part.end; ++i) {
        const double cells = distance(at(i), at(part.begin), at(part.end));
        if (cells <= most_cells) continue;
        most_cells = cells;
        farthest = i;
      }
      if (farthest == part.begin) continue;
      if (part.num_halvings >= kMaxFarthest) farthest = part.begin + (part.end - part.begin) / 2;
      is_kept_[farthest % size_] = true;
      parts.push_back({part.begin, farthest, part.num_halvings + 1});
      parts.push_back({farthest, part.end, part.num_halvings + 1});
    }
  }

  [[nodiscard]] Ring kept() const {
    Ring corners;
    for (std::size_t i = 0; i < size_; ++i) {
      if (is_kept_[i]) corners.push_back(ring_[i]);
    }
    const double length_cells = distance(corners.front(), corners.back(), corners.back());
    return corners.size() == 2 && length_cells < kSmallThing_cells ? ring_ : corners;
  }

  const Ring& ring_;
  std::size_t size_;
  std::vector<bool> is_kept_;
};

}  // namespace

std::vector<Ring> occupied_borders(const GridMap& map) { return BorderTracer(map).trace(); }

Ring straightened(const Ring& ring) { return Straightener(ring).straighten(); }

}  // namespace corridor::simulation
