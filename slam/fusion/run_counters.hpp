// What a run counted, for its result record.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "slam/backend/back_end.hpp"
#include "slam/fusion/interval_factors.hpp"
#include "slam/graph/values.hpp"

namespace corridor::fusion {

// The estimate may be used: converged or stopped by the iteration limit.
bool is_solved(const backend::BackEndReport& report);

class RunCounters {
 public:
  void count(const IntervalVerdict& verdict);
  void count(const backend::BackEndReport& report);
  void count_outvoted(int num_directions) { num_outvoted_ += num_directions; }

  void write(std::map<std::string, double>& counters) const;

 private:
  int num_slips_ = 0, num_degenerate_ = 0, num_least_bad_ = 0, num_outvoted_ = 0;
  int num_failed_solves_ = 0;
  std::int64_t num_relinearized_ = 0;
  std::int64_t num_dropped_factors_ = 0;  // by a back-end that forgets
  double chi2_ = 0;
  std::int64_t num_factors_ = 0, num_variables_ = 0;  // at the last solve
};

// The last estimate of what is calibrated on the way; bias_key: of the last IMU state, with an IMU.
void write_calibration(const graph::Values& estimate, std::uint32_t calibration,
                       std::uint32_t bias_key, bool has_imu,
                       std::map<std::string, double>& counters);

}  // namespace corridor::fusion
