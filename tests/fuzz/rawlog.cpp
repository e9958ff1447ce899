// Rawlogs through MRPT: what the framing check lets in, MRPT must read within its limits.
#include "datasets/formats/rawlog/rawlog.hpp"

#include "tests/fuzz/settle.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool rawlog(std::string_view bytes) {
  const auto parsed = formats::parse_rawlog(bytes, "log.rawlog");
  if (!parsed) return false;
  settle(*parsed);
  return true;
}

}  // namespace corridor::fuzz
