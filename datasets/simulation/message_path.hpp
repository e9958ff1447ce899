// From the moment of a reading to its stamp in the log: the sensor's clock, and what gets lost.
#pragma once

#include <optional>

#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/sensor_params.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/timestamp.hpp"

namespace corridor::simulation {

class MessagePath {
 public:
  // offset_s: the sensor's clock minus the reference.
  MessagePath(const MessageParams& params, const OutageParams& outages, double offset_s,
              const Rng& rng)
      : params_(params),
        outage_params_(outages),
        offset_s_(offset_s),
        jitter_(rng.stream("jitter")),
        losses_(rng.stream("losses")),
        outages_(rng.stream("outages")),
        next_outage_s_(time_to_outage_s()) {}

  // Stamp of a reading taken at a moment of the reference clock, later than every stamp before;
  // nullopt where the message is lost or its stamp would lie before the log's begin, 0.
  std::optional<Timestamp> stamp_of(Timestamp moment);

 private:
  double time_to_outage_s();
  bool is_silent(double moment_s);

  MessageParams params_;
  OutageParams outage_params_;
  double offset_s_;
  Rng jitter_, losses_, outages_;
  double next_outage_s_;
  std::optional<Timestamp> last_;
};

}  // namespace corridor::simulation
