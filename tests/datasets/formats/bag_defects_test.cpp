// Every defect of a ROS 1 bag is answered in one line that says what, where and what was expected.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <limits>

#include "datasets/formats/bag/bag_framing.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/log_io.hpp"
#include "tests/datasets/formats/bag_support.hpp"
#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using test::bag_bytes;
using test::odometry_message;
using test::ScratchFolder;
using test::small_bag;
using test::write_bag;
using test::write_text;

template <class T>
void expect_refused(const Result<T>& result, const std::string& what) {
  ASSERT_FALSE(result.has_value()) << what;
  const std::string line = result.error().to_line();
  EXPECT_NE(line.find(what), std::string::npos) << what << " in " << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  EXPECT_NE(line.find("a.bag"), std::string::npos) << line;
  EXPECT_NE(line.find("; expected "), std::string::npos) << line;
}

void expect_framing_refused(const std::string& bytes, const std::string& what) {
  expect_refused(check_bag_framing(bytes, "a.bag"), what);
}

// Overwrites the bytes behind the n-th `name` (its '=' included).
template <class T>
std::string with_field(std::string bytes, const std::string& name, T value, int n = 0) {
  std::size_t at = bytes.find(name);
  while (n-- > 0) at = bytes.find(name, at + 1);
  std::memcpy(bytes.data() + at + name.size(), &value, sizeof(T));
  return bytes;
}

std::string with_all(std::string bytes, const std::string& from, const std::string& to) {
  for (std::size_t at = bytes.find(from); at != std::string::npos; at = bytes.find(from, at)) {
    bytes.replace(at, from.size(), to);
    at += to.size();
  }
  return bytes;
}

TEST(BagFraming, RefusesWhatIsNoBag) {
  expect_framing_refused("", "no ROS bag");
  expect_framing_refused(std::string(5000, 'x'), "no ROS bag");
  expect_framing_refused("#ROSBAG V1.2\nabc", "another version '#ROSBAG V1.2'");
  expect_framing_refused("#ROSBAG V2.0\n", "ends early");
}

TEST(BagFraming, RefusesEveryTruncation) {
  const std::string bytes = bag_bytes(small_bag());
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    EXPECT_FALSE(check_bag_framing(std::string_view(bytes).substr(0, size), "a.bag").has_value())
        << size;
  }
  EXPECT_TRUE(check_bag_framing(bytes, "a.bag").has_value());
}

RC_GTEST_PROP(BagFraming, AnyFlippedBitIsRefusedOrChangesNoStructure, ()) {
  static const std::string kGood[] = {bag_bytes(small_bag(), ros1::Compression::kNone),
                                      bag_bytes(small_bag(), ros1::Compression::kBz2),
                                      bag_bytes(small_bag(), ros1::Compression::kLz4)};
  std::string bytes = *rc::gen::elementOf(std::vector<std::string>(kGood, kGood + 3));
  // The first 4 KiB are padding but for the file's header.
  const auto size = static_cast<int>(bytes.size());
  const auto at = static_cast<std::size_t>(
      *rc::gen::oneOf(rc::gen::inRange(0, 100), rc::gen::inRange(4096, size)));
  bytes[at] = static_cast<char>(bytes[at] ^ (1 << *rc::gen::inRange(0, 8)));
  const auto index = check_bag_framing(bytes, "a.bag");
  if (index) RC_ASSERT(index->messages.size() == small_bag().size());
}

TEST(BagFraming, RefusesABagThatWasNotClosed) {
  expect_framing_refused(with_field<std::uint64_t>(bag_bytes(small_bag()), "index_pos=", 0),
                         "not closed");
}

TEST(BagFraming, RefusesAnIndexThatLiesElsewhere) {
  const std::string bytes = bag_bytes(small_bag());
  expect_framing_refused(with_field<std::uint64_t>(bytes, "index_pos=", bytes.size() + 1),
                         "index at byte");
  expect_framing_refused(with_field<std::uint64_t>(bytes, "index_pos=", 20), "index at byte 20");
  expect_framing_refused(with_field<std::uint64_t>(bytes, "index_pos=", 5000),
                         "goes on behind the begin of the index");
}

TEST(BagFraming, RefusesLengthsThatLeadBeyondTheEnd) {
  std::string bytes = bag_bytes(small_bag());
  const std::uint32_t absurd = 0xffff'fff0U;
  std::memcpy(bytes.data() + 13, &absurd, sizeof(absurd));
  expect_framing_refused(bytes, "a.bag: byte 13: a record's header of 4294967280 bytes");
  // The file header's data length stands behind its 69 bytes.
  bytes = bag_bytes(small_bag());
  std::memcpy(bytes.data() + 13 + 4 + 69, &absurd, sizeof(absurd));
  expect_framing_refused(bytes, "a record's data of 4294967280 bytes");
}

TEST(BagFraming, RefusesFieldsThatAreNone) {
  const std::string bytes = bag_bytes(small_bag());
  expect_framing_refused(with_all(bytes, "chunk_count=", "chunk_count:"), "header field");
  expect_framing_refused(with_all(bytes, "chunk_count=", "chunk_kount="),
                         "without the field chunk_count");
  expect_framing_refused(with_field<char>(bytes, "op=", 9), "record of kind 9");
}

TEST(BagFraming, RefusesHeadersOfMoreFieldsThanAnyone) {
  const std::string bytes = bag_bytes(small_bag());
  std::string fields;
  for (int i = 100; i < 200; ++i) fields += std::string("\4\0\0\0", 4) + std::to_string(i) + "=";
  const std::size_t header = std::string_view("#ROSBAG V2.0\n").size();
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + header, sizeof(length));
  std::string many = bytes;
  many.insert(header + sizeof(length) + length, fields);
  length += static_cast<std::uint32_t>(fields.size());
  std::memcpy(many.data() + header, &length, sizeof(length));
  expect_framing_refused(many, "too many header fields");
}

TEST(BagFraming, RefusesUnknownCompressions) {
  expect_framing_refused(with_all(bag_bytes(small_bag()), "compression=none", "compression=zstd"),
                         "compression 'zstd'");
}

TEST(BagFraming, RefusesChunksThatStateTooMuch) {
  for (const auto compression : {ros1::Compression::kNone, ros1::Compression::kBz2}) {
    const std::string bytes = bag_bytes(small_bag(), compression);
    expect_framing_refused(with_field<std::uint32_t>(bytes, "size=", 0xffff'ffffU),
                           "a.bag: byte 4117: chunks of 4294967295 bytes");
    expect_framing_refused(with_field<std::uint32_t>(bytes, "size=", 128U << 20),
                           "chunk of 134217728 bytes");
  }
}

TEST(BagFraming, StopsABombAtTheSizeItStates) {
  for (const auto compression : {ros1::Compression::kBz2, ros1::Compression::kLz4}) {
    const std::string bytes = bag_bytes(small_bag(), compression);
    expect_framing_refused(with_field<std::uint32_t>(bytes, "size=", 100), "more than it states");
    expect_framing_refused(with_field<std::uint32_t>(bytes, "size=", 1U << 20), "truncated");
  }
  expect_framing_refused(with_field<std::uint32_t>(bag_bytes(small_bag()), "size=", 100),
                         "expected the 100 bytes that the chunk states");
}

TEST(BagFraming, RefusesCorruptedChunks) {
  for (const auto compression : {ros1::Compression::kBz2, ros1::Compression::kLz4}) {
    std::string bytes = bag_bytes(small_bag(), compression);
    bytes[4300] = static_cast<char>(bytes[4300] ^ 0x55);
    expect_framing_refused(bytes, "a.bag: byte 4117: ");
  }
}

TEST(BagFraming, RefusesIndexEntriesThatLeadToNoMessage) {
  const std::string bytes = bag_bytes(small_bag());
  // "ver" is the last field of an index record's header; the data follow its number and a length.
  const std::size_t version = bytes.find("ver=");
  ASSERT_NE(version, std::string::npos);
  const std::size_t record_data = version + 4 + 4 + 4;
  std::string wrong = bytes;
  const std::uint32_t offset = 1;
  std::memcpy(wrong.data() + record_data + 8, &offset, sizeof(offset));
  expect_framing_refused(wrong, "index entry for byte 1 of the chunk");
  wrong = bytes;
  const std::uint32_t seconds = 7;
  std::memcpy(wrong.data() + record_data, &seconds, sizeof(seconds));
  expect_framing_refused(wrong, "index entry for byte");
}

TEST(BagFraming, RefusesCountsThatAreNotTheFiles) {
  const std::string bytes = bag_bytes(small_bag());
  expect_framing_refused(with_field<std::uint32_t>(bytes, "chunk_count=", 99), "states 99 chunks");
  expect_framing_refused(with_field<std::uint32_t>(bytes, "conn_count=", 2), "in no list");
  expect_framing_refused(with_field<std::uint32_t>(bytes, "conn_count=", 4), "record of kind 6");
  expect_framing_refused(with_field<std::uint64_t>(bytes, "chunk_pos=", 4118),
                         "info on a chunk at byte 4118");
  // The last number of the file counts messages of the last chunk.
  std::string wrong = bytes;
  wrong[wrong.size() - 4] = static_cast<char>(wrong[wrong.size() - 4] + 1);
  expect_framing_refused(wrong, "counts other messages than the chunk has");
  expect_framing_refused(bytes + "x", "something follows the last record");
}

TEST(BagFraming, RefusesOtherDefinitionsOfKnownTypes) {
  expect_framing_refused(with_all(bag_bytes(small_bag()), "90c7ef2dc6895d81024acba2ac42f369",
                                  "90c7ef2dc6895d81024acba2ac42f36a"),
                         "sensor_msgs/LaserScan with the MD5 sum");
}

TEST(BagFraming, RefusesAConnectionThatStandsForTwoTopics) {
  std::string bytes = bag_bytes(small_bag());
  const std::size_t last = bytes.rfind("topic=/imu");
  bytes.replace(last, 10, "topic=/imx");
  expect_framing_refused(bytes, "stands for '/imu' already");
}

TEST(BagFraming, RefusesMessagesOfUnknownConnections) {
  const std::string bytes = bag_bytes(small_bag());
  // The second "conn=" is that of the first message behind the connection's record.
  expect_framing_refused(with_field<std::uint32_t>(bytes, "conn=", 77, 1),
                         "message of the unknown connection 77");
}

TEST(BagFraming, RefusesLengthsInsideMessagesBeforeRosAllocates) {
  std::string bytes = bag_bytes(small_bag());
  // "laser" ends the header; seven floats later stands the number of ranges.
  const std::size_t frame = bytes.find(std::string("\x05\0\0\0laser", 9));
  ASSERT_NE(frame, std::string::npos);
  const std::uint32_t absurd = 4'000'000'000U;
  std::string wrong = bytes;
  std::memcpy(wrong.data() + frame + 9 + 28, &absurd, sizeof(absurd));
  expect_framing_refused(wrong, "number of ranges is 4000000000; expected at most 65536");
  wrong = bytes;
  std::memcpy(wrong.data() + frame, &absurd, sizeof(absurd));
  expect_framing_refused(wrong, "the header's frame is 4000000000");
  wrong = bytes;
  wrong[frame + 9 + 28] = 6;
  expect_framing_refused(wrong, "the message ends inside number of intensities");
  wrong = bytes;
  wrong[frame + 9 + 28] = 4;
  expect_framing_refused(wrong, "number of intensities is");
  wrong = bytes;
  const std::uint32_t too_many_ns = 1'000'000'000U;
  std::memcpy(wrong.data() + frame - 4, &too_many_ns, sizeof(too_many_ns));
  expect_framing_refused(wrong, "1000000000 nanoseconds");
}

// Defects of values: written by rosbag, read through the door.
template <class Change>
void expect_log_refused(Change change, const std::string& what) {
  auto messages = small_bag();
  change(messages);
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages);
  expect_refused(read_log(folder / "a.bag"), what);
}

ros1::Scan& scan_of(std::vector<ros1::Message>& messages) {
  return std::get<ros1::Scan>(messages[2].content);
}

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(BagDefects, ScansThatAreNone) {
  using Messages = std::vector<ros1::Message>;
  expect_log_refused([](Messages& m) { scan_of(m).ranges_m[1] = -1; }, "range -1 m of beam 1");
  expect_log_refused([](Messages& m) { scan_of(m).ranges_m.clear(); }, "without beams");
  expect_log_refused([](Messages& m) { scan_of(m).ranges_m.resize(9, 1); }, "9 ranges");
  expect_log_refused([](Messages& m) { scan_of(m).angle_increment_rad = 0; }, "5 ranges");
  expect_log_refused([](Messages& m) { scan_of(m).angle_increment_rad = kNaN; }, "not finite");
  expect_log_refused([](Messages& m) { scan_of(m).range_max_m = 0; }, "ranges from");
  expect_log_refused([](Messages& m) { scan_of(m).range_max_m = kNaN; }, "not finite");
}

TEST(BagDefects, PosesThatAreNone) {
  using Messages = std::vector<ros1::Message>;
  const auto odometry = [](Messages& m) -> ros1::Odometry& {
    return std::get<ros1::Odometry>(m[0].content);
  };
  expect_log_refused([&](Messages& m) { odometry(m).qw = 0; }, "quaternion of length 0");
  expect_log_refused([&](Messages& m) { odometry(m).x_m = kNaN; }, "not finite");
  expect_log_refused([&](Messages& m) { odometry(m) = {0, 0, 0.6, 0, 0, 0.8}; }, "roll or pitch");
}

TEST(BagDefects, AnImuReadingThatIsNone) {
  expect_log_refused(
      [](std::vector<ros1::Message>& m) { std::get<ros1::Imu>(m[1].content).gyro_z_radps = kNaN; },
      "not finite");
}

TEST(BagDefects, StampsThatStepBackOrRepeatWithinATopic) {
  using Messages = std::vector<ros1::Message>;
  expect_log_refused([](Messages& m) { m[3].stamp_ns -= 50'000'000; }, "stamp steps back");
  expect_log_refused([](Messages& m) { m[3].stamp_ns = m[0].stamp_ns; }, "stamp repeats");
  expect_log_refused([](Messages& m) { m.back().stamp_ns += 20'000'000'000; }, "gap");
}

TEST(BagDefects, NoScansOrNotTheTopicThatIsNamed) {
  expect_log_refused(
      [](std::vector<ros1::Message>& m) {
        std::erase_if(m, [](const ros1::Message& each) { return each.topic == "/scan"; });
      },
      "no scans");
  const ScratchFolder folder;
  write_bag(folder / "a.bag", small_bag());
  for (const std::string topic : {"/scam", "/odom"}) {
    write_text(folder / "a.topics.toml",
               std::string("[topics]\nscan = \"").append(topic).append("\"\n"));
    expect_refused(read_log(folder / "a.bag"),
                   std::string("topic '").append(topic).append("' is not in the bag"));
  }
}

TEST(BagDefects, JointsWithoutTheirPositions) {
  auto messages = small_bag();
  messages.push_back({"/joints", 101'000'000'000, 101'000'000'000, ros1::Joints{{"L", "R"}, {1}}});
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages);
  write_text(folder / "a.topics.toml",
             "[topics]\njoints = \"/joints\"\n"
             "[joints]\nleft = \"L\"\nright = \"R\"\nticks_per_turn = 1000\n");
  expect_refused(read_log(folder / "a.bag"), "1 joint positions");
  messages.back().content = ros1::Joints{{"L", "R"}, {1, kNaN}};
  write_bag(folder / "a.bag", messages);
  expect_refused(read_log(folder / "a.bag"), "of joint R");
}

TEST(BagDefects, ABagThatIsCompressedAsAWhole) {
  const ScratchFolder folder;
  write_text(folder / "a.bag", *gzip(bag_bytes(small_bag())));
  expect_refused(read_log(folder / "a.bag"), "compressed as a whole");
}

TEST(BagDefects, AnEmptyFile) {
  const ScratchFolder folder;
  write_text(folder / "a.bag", "");
  expect_refused(read_log(folder / "a.bag"), "empty");
}

}  // namespace
}  // namespace corridor::formats
