// The check that comes before MRPT.
#include "datasets/formats/rawlog/rawlog_framing.hpp"

#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool rawlog_framing(std::string_view bytes) {
  return formats::check_rawlog_frames(bytes, "log.rawlog").has_value();
}

}  // namespace corridor::fuzz
