// CARMEN text logs, with what follows the parser.
#include "datasets/formats/carmen/carmen.hpp"

#include "tests/fuzz/settle.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool carmen(std::string_view bytes) {
  formats::CarmenOptions options;
  options.flaser_range_max_m = 81;
  const auto parsed = formats::parse_carmen(bytes, "log.clf", options);
  if (!parsed) return false;
  settle(*parsed);
  return true;
}

}  // namespace corridor::fuzz
