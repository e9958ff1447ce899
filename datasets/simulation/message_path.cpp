#include "datasets/simulation/message_path.hpp"

#include <algorithm>
#include <cmath>

namespace corridor::simulation {
namespace {

// Stamps that jitter would turn round stand this far apart.
constexpr std::int64_t kLeastStep_ns = 1000;

}  // namespace

// Exponential, so that no moment is likelier than another.
double MessagePath::time_to_outage_s() {
  return -outage_params_.interval_s * std::log(1 - outages_.uniform());
}

bool MessagePath::is_silent(double moment_s) {
  if (outage_params_.duration_s == 0) return false;
  while (moment_s >= next_outage_s_ + outage_params_.duration_s) {
    next_outage_s_ += outage_params_.duration_s + time_to_outage_s();
  }
  return moment_s >= next_outage_s_;
}

std::optional<Timestamp> MessagePath::stamp_of(Timestamp moment) {
  const double jitter_s = params_.time_jitter_s > 0 ? jitter_.normal(0, params_.time_jitter_s) : 0;
  const double error_s = offset_s_ + jitter_s;
  const bool is_silenced = is_silent(to_seconds(moment));
  const bool is_lost =
      (params_.loss_ratio > 0 && losses_.uniform() < params_.loss_ratio) || is_silenced;
  Timestamp stamp{moment.nanoseconds + timestamp_from_seconds(error_s).nanoseconds};
  if (last_) stamp.nanoseconds = std::max(stamp.nanoseconds, last_->nanoseconds + kLeastStep_ns);
  if (is_lost || stamp.nanoseconds < 0) return std::nullopt;
  last_ = stamp;
  return stamp;
}

}  // namespace corridor::simulation
