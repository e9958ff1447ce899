#include "datasets/simulation/slips.hpp"

#include <algorithm>
#include <cmath>

#include "slam/core/expect.hpp"

namespace corridor::simulation {
namespace {

constexpr double kLeastSlip_mps = 0.01;

// The event at a moment, if there is one.
const SlipInterval* event_at(const std::vector<SlipInterval>& slips, double time_s) {
  for (const SlipInterval& slip : slips) {
    const bool is_event = slip.cause == SlipCause::kEvent;
    if (is_event && time_s >= slip.begin_s && time_s < slip.end_s) return &slip;
  }
  return nullptr;
}

// A step belongs to the event that its middle lies in: what overlaps is a part of a step.
void cut_at_events(const std::vector<SlipInterval>& events, SlipInterval& slip) {
  for (const SlipInterval& event : events) {
    if (event.end_s <= slip.begin_s || slip.end_s <= event.begin_s) continue;
    (event.begin_s <= slip.begin_s ? slip.begin_s : slip.end_s) =
        event.begin_s <= slip.begin_s ? event.end_s : event.begin_s;
  }
}

int number_of(const SlipParams& params, double drive_s) {
  if (params.share == 0) return params.num_slips;
  return static_cast<int>(std::lround(params.share * drive_s / params.duration_s));
}

}  // namespace

// Sorted uniform points of the time that the slips leave free, each shifted by those before it.
std::vector<SlipInterval> drawn_slips(const SlipParams& params, double drive_s, Rng rng) {
  const int num_slips = number_of(params, drive_s);
  const double free_s = drive_s - num_slips * params.duration_s;
  CORRIDOR_EXPECT(free_s >= 0);  // violations(scenario) says whether the drive is long enough
  std::vector<double> begins_s;
  for (int i = 0; i < num_slips; ++i) begins_s.push_back(rng.uniform(0, free_s));
  std::sort(begins_s.begin(), begins_s.end());
  std::vector<SlipInterval> slips;
  for (const double begin_s : begins_s) {
    const double shifted_s = begin_s + static_cast<double>(slips.size()) * params.duration_s;
    slips.push_back({shifted_s, shifted_s + params.duration_s, params.ratio, SlipCause::kEvent});
  }
  return slips;
}

void append_friction_slips(const Drive& drive, std::vector<SlipInterval>& slips) {
  std::vector<SlipInterval> found;
  double wheel_m = 0, robot_m = 0;
  bool is_open = false;
  for (std::size_t k = 1; k < drive.states.size(); ++k) {
    const DriveState& state = drive.states[k];
    const double middle_s = (static_cast<double>(k) - 0.5) * drive.step_s;
    const bool is_slipping = std::abs(state.wheel_speed_mps - state.speed_mps) > kLeastSlip_mps &&
                             event_at(slips, middle_s) == nullptr;
    if (is_slipping && !is_open) {
      const double begin_s = static_cast<double>(k - 1) * drive.step_s;
      found.push_back({begin_s, begin_s, 0, SlipCause::kGrip});
      wheel_m = robot_m = 0;
    }
    is_open = is_slipping;
    if (!is_slipping) continue;
    const DriveState& before = drive.states[k - 1];
    wheel_m +=
        0.5 * (std::abs(before.wheel_speed_mps) + std::abs(state.wheel_speed_mps)) * drive.step_s;
    robot_m += 0.5 * (std::abs(before.speed_mps) + std::abs(state.speed_mps)) * drive.step_s;
    found.back().end_s = static_cast<double>(k) * drive.step_s;
    found.back().ratio = robot_m > 0 ? wheel_m / robot_m - 1 : 0;
  }
  for (SlipInterval& slip : found) cut_at_events(slips, slip);
  slips.insert(slips.end(), found.begin(), found.end());
  std::sort(slips.begin(), slips.end(),
            [](const SlipInterval& a, const SlipInterval& b) { return a.begin_s < b.begin_s; });
}

double event_ratio_at(const std::vector<SlipInterval>& slips, double time_s) {
  const SlipInterval* event = event_at(slips, time_s);
  return event == nullptr ? 0 : event->ratio;
}

}  // namespace corridor::simulation
