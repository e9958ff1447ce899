#include "slam/fusion/run_counters.hpp"

namespace corridor::fusion {

bool is_solved(const backend::BackEndReport& report) {
  return report.status == backend::SolveStatus::kConverged ||
         report.status == backend::SolveStatus::kMaxIterations;
}

void RunCounters::count(const IntervalVerdict& verdict) {
  num_slips_ += verdict.is_slip ? 1 : 0;
  num_degenerate_ += verdict.is_degenerate ? 1 : 0;
  num_least_bad_ += verdict.is_least_bad_kept ? 1 : 0;
}

void RunCounters::count(const backend::BackEndReport& report) {
  num_failed_solves_ += is_solved(report) ? 0 : 1;
  num_relinearized_ += report.num_relinearized;
  num_dropped_factors_ += report.num_dropped_factors;
  chi2_ = report.chi2;
  num_factors_ = report.num_factors;
  num_variables_ = report.num_variables;
}

void RunCounters::write(std::map<std::string, double>& counters) const {
  counters["failed_solves"] = num_failed_solves_;
  counters["slip_intervals"] = num_slips_;
  counters["degenerate_intervals"] = num_degenerate_;
  counters["outvoted_directions"] = num_outvoted_;
  counters["least_bad_kept"] = num_least_bad_;
  counters["chi2"] = chi2_;
  counters["factors"] = static_cast<double>(num_factors_);
  counters["variables"] = static_cast<double>(num_variables_);
  counters["relinearised"] = static_cast<double>(num_relinearized_);
  if (num_dropped_factors_ > 0) {
    counters["dropped_factors"] = static_cast<double>(num_dropped_factors_);
  }
}

void write_calibration(const graph::Values& estimate, std::uint32_t calibration,
                       std::uint32_t bias_key, bool has_imu,
                       std::map<std::string, double>& counters) {
  const motion::WheelCalibration& wheels = estimate.wheel_calibration(calibration);
  counters["wheel_scale"] = wheels(motion::kScale);
  counters["wheel_unbalance_radpm"] = wheels(motion::kUnbalance);
  counters["wheel_turn"] = wheels(motion::kTurn);
  counters["wheel_delay_s"] = wheels(motion::kDelay);
  counters["axle_x_m"] = wheels(motion::kAxleX);
  counters["axle_y_m"] = wheels(motion::kAxleY);
  counters["axle_theta_rad"] = wheels(motion::kAxleTheta);
  if (has_imu) counters["gyro_scale"] = estimate.bias(bias_key)(3);
}

}  // namespace corridor::fusion
