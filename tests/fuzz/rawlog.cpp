// Rawlogs through MRPT: what the framing check lets in, MRPT must read within its limits. A fit log
// is written and read again.
#include "datasets/formats/rawlog/rawlog.hpp"

#include "tests/fuzz/settle.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool rawlog(std::string_view bytes) {
  const auto parsed = formats::parse_rawlog(bytes, "log.rawlog");
  if (!parsed) return false;
  for (const SensorLog& log : settle(*parsed)) {
    const auto written = formats::rawlog_bytes(log);
    if (written) expect_same_readings(log, formats::parse_rawlog(*written, "again.rawlog"));
  }
  return true;
}

}  // namespace corridor::fuzz
