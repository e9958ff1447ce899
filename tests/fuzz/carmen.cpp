// CARMEN text logs, with what follows the parser. A fit log is written and read again.
#include "datasets/formats/carmen/carmen.hpp"

#include "tests/fuzz/settle.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool carmen(std::string_view bytes) {
  formats::CarmenOptions options;
  options.flaser_range_max_m = 81;
  const auto parsed = formats::parse_carmen(bytes, "log.clf", options);
  if (!parsed) return false;
  for (const SensorLog& log : settle(*parsed)) {
    const auto again = formats::parse_carmen(formats::carmen_text(log), "again.clf", {});
    constexpr bool kHoldsAll = false;  // no IMU; a pose with every scan
    expect_same_readings(log, again, kHoldsAll);
  }
  return true;
}

}  // namespace corridor::fuzz
