// Bags through rosbag, which opens a file: LOG.topics.toml, the separator, the bag. What the
// framing check lets in, rosbag must read. A fit log is written and read again.
#include "datasets/formats/bag/bag.hpp"

#include <string>

#include "datasets/formats/file_bytes.hpp"
#include "slam/core/expect.hpp"
#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/settle.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

namespace {

void write_and_read(const SensorLog& log) {
  const auto messages = formats::ros_messages(log, "again.bag");
  if (!messages) return;
  const MemoryFile file("", MemoryFile::kSecond);
  using formats::ros1::Compression;
  CORRIDOR_EXPECT(
      formats::ros1::write_messages(file.path(), *messages, Compression::kNone).has_value());
  const auto written = formats::read_file_bytes(file.path());
  CORRIDOR_EXPECT(written.has_value());
  expect_same_readings(log, formats::parse_bag(*written, file.path(), {}));
}

}  // namespace

bool bag(std::string_view bytes) {
  const auto [toml, log] = split(bytes);
  // Without a text before it, a bag beside which no LOG.topics.toml lies.
  const Result<formats::BagTopics> topics =
      toml.empty() ? formats::BagTopics{} : formats::bag_topics_from_toml(toml, "log.topics.toml");
  if (!topics) return false;
  const MemoryFile file(log);
  for (const bool keeps_record_order : {false, true}) {
    const auto parsed = formats::parse_bag(log, file.path(), {*topics, keeps_record_order});
    if (!parsed) return false;
    for (const SensorLog& fit : settle(*parsed)) write_and_read(fit);
  }
  return true;
}

}  // namespace corridor::fuzz
