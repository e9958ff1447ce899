#include "datasets/formats/uniform_fan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "datasets/formats/median.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::formats {
namespace {

constexpr double kFullTurn_rad = 2 * std::numbers::pi;
constexpr double kMicrosecondsPerSecond = 1e6;
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;
// Steps between neighbouring beams are shorter; longer ones are gaps or the seam.
constexpr double kMaxStep_rad = 0.2;
// A step this much longer than the median has lost a beam.
constexpr double kRegular_ratio = 1.5;

double wrap_to_turn(double angle_rad) {
  const double rest_rad = std::fmod(angle_rad, kFullTurn_rad);
  return rest_rad < 0 ? rest_rad + kFullTurn_rad : rest_rad;
}

// Angles come in units of the sensor, and so does their median; the mean of the regular steps is
// finer.
double regular_step_rad(const std::vector<double>& steps_rad) {
  const double longest_rad = kRegular_ratio * upper_median(steps_rad);
  double sum_rad = 0;
  std::size_t count = 0;
  for (const double step_rad : steps_rad) {
    if (step_rad > longest_rad) continue;
    sum_rad += step_rad;
    ++count;
  }
  return sum_rad / static_cast<double>(count);
}

// A turn's angles lie on both sides of 0: the median of what is left over from a reference.
double median_angle_rad(const std::vector<double>& angles_rad) {
  std::vector<double> differences_rad;
  differences_rad.reserve(angles_rad.size());
  for (const double angle_rad : angles_rad) {
    differences_rad.push_back(wrap_angle(angle_rad - angles_rad.front()));
  }
  return wrap_angle(angles_rad.front() + upper_median(std::move(differences_rad)));
}

// y = at_zero + slope * x.
struct Line {
  double at_zero = 0;
  double slope = 0;
};

Line least_squares(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  double xx = 0;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  const double slope = xx > 0 ? xy / xx : 0;
  return {mean_y - slope * mean_x, slope};
}

// The fan of one sweep while it is filled.
class Fan {
 public:
  Fan(const Sweep& sweep, const FanShape& shape, double range_max_m, FanLosses& losses)
      : sweep_(sweep),
        shape_(shape),
        range_max_m_(range_max_m),
        losses_(losses),
        step_rad_(kFullTurn_rad / static_cast<double>(shape.num_beams)),
        beam_of_place_(shape.num_beams) {}

  LaserScan fill() {
    losses_.num_beams += sweep_.ranges_m.size();
    find_phase();
    for (std::size_t beam = 0; beam < sweep_.ranges_m.size(); ++beam) take(beam);
    LaserScan scan;
    scan.range_max_m = range_max_m_;
    scan.angle_increment_rad = step_rad_;
    scan.angle_min_rad = angle_min_rad();
    set_times(scan);
    set_ranges(scan);
    return scan;
  }

 private:
  [[nodiscard]] bool is_return(std::size_t beam) const {
    return sweep_.ranges_m[beam] > 0 && sweep_.ranges_m[beam] <= range_max_m_;
  }
  // From the middle of place 0, without the phase.
  [[nodiscard]] double past_first_rad(std::size_t beam) const {
    return wrap_to_turn(sweep_.angles_rad[beam] - shape_.seam_rad) - 0.5 * step_rad_;
  }
  // 0 for the first beam, 1 for the last.
  [[nodiscard]] double part_of_sweep(std::size_t beam) const {
    const std::int64_t all_us = sweep_.times_us.back() - sweep_.times_us.front();
    if (all_us <= 0) return 0.5;
    return static_cast<double>(sweep_.times_us[beam] - sweep_.times_us.front()) /
           static_cast<double>(all_us);
  }

  // The circular mean of the beams' remainders within a place.
  void find_phase() {
    double sum_sin = 0;
    double sum_cos = 0;
    for (std::size_t beam = 0; beam < sweep_.ranges_m.size(); ++beam) {
      if (!is_return(beam)) continue;
      const double part_rad = past_first_rad(beam) / step_rad_ * kFullTurn_rad;
      sum_sin += std::sin(part_rad);
      sum_cos += std::cos(part_rad);
    }
    phase_rad_ = std::atan2(sum_sin, sum_cos) / kFullTurn_rad * step_rad_;
  }

  void take(std::size_t beam) {
    const double angle_rad = past_first_rad(beam) - phase_rad_;
    const auto nearest = static_cast<std::int64_t>(std::lround(angle_rad / step_rad_));
    const auto n = static_cast<std::int64_t>(shape_.num_beams);
    const auto place = static_cast<std::size_t>(((nearest % n) + n) % n);
    const double part = static_cast<double>(place) / static_cast<double>(n);
    if (std::abs(part - part_of_sweep(beam)) > 0.5) {
      ++losses_.num_beyond_seam;
      return;
    }
    if (is_return(beam)) {
      const double moved_rad = std::abs(angle_rad - static_cast<double>(nearest) * step_rad_);
      ++losses_.num_returns;
      losses_.sum_moved_rad2 += moved_rad * moved_rad;
      losses_.max_moved_rad = std::max(losses_.max_moved_rad, moved_rad);
    }
    auto& holder = beam_of_place_[place];
    if (!holder) {
      holder = beam;
      return;
    }
    const bool is_lost = is_return(beam) && is_return(*holder);
    ++(is_lost ? losses_.num_shared_returns : losses_.num_shared);
    const bool is_nearer = is_return(beam) && (!is_return(*holder) ||
                                               sweep_.ranges_m[beam] < sweep_.ranges_m[*holder]);
    if (is_nearer) holder = beam;
  }

  [[nodiscard]] std::size_t scan_index(std::size_t place) const {
    return shape_.is_clockwise ? shape_.num_beams - 1 - place : place;
  }

  [[nodiscard]] double angle_min_rad() const {
    const double first_rad = shape_.seam_rad + 0.5 * step_rad_ + phase_rad_;
    if (!shape_.is_clockwise) return wrap_angle(first_rad);
    const double last_rad = first_rad + step_rad_ * static_cast<double>(shape_.num_beams - 1);
    return wrap_angle(-last_rad);
  }

  // Angles of beams without return may lack the sensor's correction for range: they tell the time
  // only where too few have one.
  void set_times(LaserScan& scan) {
    Line line = line_of_times(true);
    if (line.slope <= 0) line = line_of_times(false);
    const double n_minus_1 = static_cast<double>(shape_.num_beams - 1);
    const double first_us = line.at_zero + (shape_.is_clockwise ? n_minus_1 * line.slope : 0);
    const double duration_us =
        std::round(n_minus_1 * (shape_.is_clockwise ? -line.slope : line.slope));
    scan.stamp = {(sweep_.times_us.front() + std::llround(first_us)) * kNanosecondsPerMicrosecond};
    scan.duration_s = duration_us / kMicrosecondsPerSecond;
    for (std::size_t place = 0; place < shape_.num_beams; ++place) {
      if (!beam_of_place_[place]) continue;
      const double expected_us = line.at_zero + line.slope * static_cast<double>(place);
      const double off_us = since_first_us(*beam_of_place_[place]) - expected_us;
      if (std::abs(off_us) > FanLosses::kNoticed_s * kMicrosecondsPerSecond) ++losses_.num_late;
    }
  }

  [[nodiscard]] Line line_of_times(bool use_returns_only) const {
    std::vector<double> places;
    std::vector<double> times_us;
    for (std::size_t place = 0; place < shape_.num_beams; ++place) {
      const auto& beam = beam_of_place_[place];
      if (!beam || (use_returns_only && !is_return(*beam))) continue;
      places.push_back(static_cast<double>(place));
      times_us.push_back(since_first_us(*beam));
    }
    return places.empty() ? Line{} : least_squares(places, times_us);
  }

  [[nodiscard]] double since_first_us(std::size_t beam) const {
    return static_cast<double>(sweep_.times_us[beam] - sweep_.times_us.front());
  }

  void set_ranges(LaserScan& scan) {
    scan.ranges_m.assign(shape_.num_beams, 0.0F);
    scan.is_valid.assign(shape_.num_beams, 0);
    for (std::size_t place = 0; place < shape_.num_beams; ++place) {
      const auto& beam = beam_of_place_[place];
      if (!beam) {
        ++losses_.num_without_beam;
        continue;
      }
      scan.ranges_m[scan_index(place)] = static_cast<float>(sweep_.ranges_m[*beam]);
      scan.is_valid[scan_index(place)] = is_return(*beam) ? 1 : 0;
    }
  }

  const Sweep& sweep_;
  const FanShape& shape_;
  double range_max_m_;
  FanLosses& losses_;
  double step_rad_;
  double phase_rad_ = 0;
  std::vector<std::optional<std::size_t>> beam_of_place_;
};

}  // namespace

FanShape fan_shape(const std::vector<Sweep>& sweeps, bool is_clockwise) {
  std::vector<double> steps_rad;
  std::vector<double> first_rad;
  std::vector<double> last_rad;
  for (const Sweep& sweep : sweeps) {
    if (sweep.angles_rad.empty()) continue;
    first_rad.push_back(sweep.angles_rad.front());
    last_rad.push_back(sweep.angles_rad.back());
    for (std::size_t i = 1; i < sweep.angles_rad.size(); ++i) {
      const double step_rad = wrap_angle(sweep.angles_rad[i] - sweep.angles_rad[i - 1]);
      if (step_rad > 0 && step_rad < kMaxStep_rad) steps_rad.push_back(step_rad);
    }
  }
  FanShape shape;
  shape.is_clockwise = is_clockwise;
  if (steps_rad.empty()) return shape;
  shape.num_beams =
      static_cast<std::size_t>(std::lround(kFullTurn_rad / regular_step_rad(steps_rad)));
  const double last = median_angle_rad(last_rad);
  shape.seam_rad = wrap_angle(last + 0.5 * wrap_angle(median_angle_rad(first_rad) - last));
  return shape;
}

LaserScan uniform_fan(const Sweep& sweep, const FanShape& shape, double range_max_m,
                      FanLosses& losses) {
  return Fan(sweep, shape, range_max_m, losses).fill();
}

}  // namespace corridor::formats
