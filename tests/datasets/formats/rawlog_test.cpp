#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/formats/rawlog/rawlog.hpp"
#include "datasets/formats/rawlog/rawlog_framing.hpp"
#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using test::read_text;
using test::same_events;
using test::ScratchFolder;
using test::small_log;
using test::write_text;

bool contains(const Error& error, const std::string& part) {
  return error.to_line().find(part) != std::string::npos;
}

TEST(Rawlog, ReadUndoesWrite) {
  const ScratchFolder folder;
  const SensorLog log = small_log();
  ASSERT_TRUE(write_rawlog(log, folder / "a.rawlog"));
  const auto read = read_log(folder / "a.rawlog");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_TRUE(same_events(log, *read));
  EXPECT_EQ(read->robot.name, log.robot.name);
  EXPECT_EQ(read->robot.lidar.T_base_lidar, log.robot.lidar.T_base_lidar);
  EXPECT_EQ(read->robot.imu.T_base_imu, log.robot.imu.T_base_imu);
  const std::vector<std::string> notes = {
      "4 beams at the LiDAR's limit or beyond taken as no return"};
  EXPECT_EQ(read->provenance.notes, notes) << read->provenance.notes.front();
}

TEST(Rawlog, WritingTwiceGivesTheSameBytes) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_rawlog(small_log(), folder / "a.rawlog"));
  ASSERT_TRUE(write_rawlog(small_log(), folder / "b.rawlog"));
  EXPECT_EQ(read_text(folder / "a.rawlog"), read_text(folder / "b.rawlog"));
}

TEST(Rawlog, LimitsThatAreNotFloatsComeBackExactly) {
  const ScratchFolder folder;
  SensorLog log = small_log();
  log.robot.lidar.range_max_m = 5.1;
  for (auto& event : log.events) {
    if (auto* scan = std::get_if<LaserScan>(&event)) scan->range_max_m = 5.1;
  }
  ASSERT_TRUE(write_rawlog(log, folder / "a.rawlog"));
  const auto read = read_log(folder / "a.rawlog");
  ASSERT_TRUE(read.has_value());
  EXPECT_TRUE(same_events(log, *read));
}

TEST(Rawlog, AFanThatIsNotSymmetricKeepsItsBeamsInTheBaseFrame) {
  const ScratchFolder folder;
  SensorLog log = small_log();
  for (auto& event : log.events) {
    if (auto* scan = std::get_if<LaserScan>(&event)) scan->angle_min_rad = -0.5;
  }
  ASSERT_TRUE(write_rawlog(log, folder / "a.rawlog"));
  const auto read = read_log(folder / "a.rawlog");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  for (std::size_t i = 0; i < log.events.size(); ++i) {
    const auto* in = std::get_if<LaserScan>(&log.events[i]);
    if (in == nullptr) continue;
    const auto& out = std::get<LaserScan>(read->events[i]);
    for (std::size_t beam = 0; beam < in->num_beams(); ++beam) {
      EXPECT_LT((in->point_base_m(beam) - out.point_base_m(beam)).norm(), 1e-6);
    }
  }
  const auto losses = losses_of_conversion(log, LogFormat::kRawlog);
  EXPECT_NE(losses.at(0).find("LiDAR frame turned"), std::string::npos);
}

TEST(Rawlog, StampsAreRoundedTo100NanosecondsAndConvertSaysSo) {
  const ScratchFolder folder;
  SensorLog log = small_log();
  std::get<ImuSample>(log.events[0]).stamp.nanoseconds = -151;
  ASSERT_TRUE(write_rawlog(log, folder / "a.rawlog"));
  const auto read = read_log(folder / "a.rawlog");
  EXPECT_EQ(stamp_of(read->events[0]).nanoseconds, -200);
  EXPECT_EQ(losses_of_conversion(log, LogFormat::kRawlog).at(0), "1 stamps are rounded to 100 ns");
}

TEST(Rawlog, TicksBeyond32BitsAreAnErrorThatLeavesNoFile) {
  const ScratchFolder folder;
  SensorLog log = small_log();
  for (auto& event : log.events) {
    if (auto* sample = std::get_if<WheelSample>(&event)) sample->ticks = WheelTicks{1LL << 40, 0};
  }
  EXPECT_FALSE(write_rawlog(log, folder / "a.rawlog").has_value());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Plain bytes, so that the framing check and not gzip's checksum has to find the damage.
TEST(Rawlog, FramingTruncatedAnywhereIsAnErrorOrEndsAtAnObject) {
  const ScratchFolder folder;
  const std::string bytes = *rawlog_bytes(small_log());
  const auto frames = check_rawlog_frames(bytes, "a");
  ASSERT_TRUE(frames.has_value());
  std::vector<bool> is_boundary(bytes.size() + 1, false);
  for (const RawlogFrame& frame : *frames) is_boundary[frame.begin] = true;
  for (std::size_t length = 1; length < bytes.size(); length += 7) {
    const auto cut = check_rawlog_frames(std::string_view(bytes).substr(0, length), "a");
    EXPECT_EQ(cut.has_value(), is_boundary[length]) << "cut at byte " << length;
    if (!cut) {
      EXPECT_TRUE(contains(cut.error(), "a: byte ")) << cut.error().to_line();
    }
  }
  write_text(folder / "a.rawlog", bytes.substr(0, bytes.size() - 1));
  const auto read = read_log(folder / "a.rawlog");
  ASSERT_FALSE(read.has_value());
  EXPECT_TRUE(contains(read.error(), "the file ends inside an object's end flag"));
}

TEST(Rawlog, OneOfTheSuitesOwnThatIsCutBetweenTwoObjectsIsAnError) {
  const ScratchFolder folder;
  const std::string bytes = *rawlog_bytes(small_log());
  const auto frames = check_rawlog_frames(bytes, "a");
  ASSERT_TRUE(frames.has_value());
  for (std::size_t i = 1; i < frames->size(); ++i) {
    const auto cut = parse_rawlog(std::string_view(bytes).substr(0, frames->at(i).begin), "a");
    ASSERT_FALSE(cut.has_value()) << i - 1 << " readings";
    EXPECT_EQ(cut.error().to_line(),
              fmt::format("a: {} readings; expected {}, as the log's own comment says: it was cut, "
                          "or its objects changed",
                          i - 1, frames->size() - 1));
  }
}

TEST(Rawlog, ThatStatesNoNumberOfReadingsIsReadAsFarAsItGoes) {
  std::string bytes = *rawlog_bytes(small_log());
  bytes[bytes.find("# readings that follow:") + 2] = 'R';  // as others' comments
  const auto frames = check_rawlog_frames(bytes, "a");
  const auto read = parse_rawlog(std::string_view(bytes).substr(0, frames->back().begin), "a");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->events.size(), small_log().events.size() - 1);
}

TEST(Rawlog, ANumberOfReadingsThatIsNoneIsAnError) {
  std::string bytes = *rawlog_bytes(small_log());
  bytes[bytes.find("follow: ") + 8] = 'x';
  const auto read = parse_rawlog(bytes, "a");
  ASSERT_FALSE(read.has_value());
  EXPECT_TRUE(contains(read.error(), "number of readings")) << read.error().to_line();
  EXPECT_TRUE(contains(read.error(), "a: byte 0")) << read.error().to_line();
}

TEST(Rawlog, PackedFilesTruncatedAtEvery97thByteAreErrors) {
  const ScratchFolder folder;
  const std::string packed = *gzip(*rawlog_bytes(small_log()));
  for (std::size_t length = 0; length < packed.size(); length += 97) {
    write_text(folder / "a.rawlog", packed.substr(0, length));
    EXPECT_FALSE(read_log(folder / "a.rawlog").has_value()) << "cut at byte " << length;
  }
}

TEST(Rawlog, PlainFilesTruncatedAtEvery97thByteAreErrors) {
  const ScratchFolder folder;
  const std::string plain = *rawlog_bytes(small_log());
  for (std::size_t length = 0; length < plain.size(); length += 97) {
    write_text(folder / "a.rawlog", plain.substr(0, length));
    EXPECT_FALSE(read_log(folder / "a.rawlog").has_value()) << "cut at byte " << length;
  }
}

TEST(Rawlog, AFlippedBitNeverCrashesOrGrowsTheLog) {
  const ScratchFolder folder;
  const std::string bytes = *rawlog_bytes(small_log());
  const std::size_t num_events = small_log().events.size();
  for (std::size_t byte = 0; byte < bytes.size(); byte += 5) {
    std::string flipped = bytes;
    flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << (byte % 8)));
    const auto parsed = parse_rawlog(flipped, "a");
    if (parsed) {
      EXPECT_LE(parsed->events.size(), num_events) << "bit flipped in byte " << byte;
    }
  }
}

TEST(Rawlog, AnAbsurdBeamCountIsRefusedBeforeAnythingIsAllocated) {
  std::string bytes = *rawlog_bytes(small_log());
  const std::size_t scan = bytes.find("CObservation2DRangeScan");
  const std::size_t pose = bytes.find("CPose3D", scan);
  // Class name, version, 12 doubles, end flag, then the count.
  const std::size_t count = pose + 7 + 1 + 96 + 1;
  const std::uint32_t absurd = 4'000'000'000U;
  std::memcpy(bytes.data() + count, &absurd, sizeof(absurd));
  const auto frames = check_rawlog_frames(bytes, "a");
  ASSERT_FALSE(frames.has_value());
  EXPECT_TRUE(contains(frames.error(), "byte " + std::to_string(count) +
                                           ": number of beams is 4000000000; expected at most"));
}

TEST(Rawlog, AMissingEndFlagIsNamedByItsByte) {
  std::string bytes = *rawlog_bytes(small_log());
  const RawlogFrame frame = check_rawlog_frames(bytes, "a")->at(1);
  const std::size_t flag = frame.begin + frame.size - 1;
  bytes[flag] = 'x';
  const auto frames = check_rawlog_frames(bytes, "a");
  ASSERT_FALSE(frames.has_value());
  EXPECT_TRUE(contains(frames.error(), "a: byte " + std::to_string(flag) + ": byte 0x78 after"))
      << frames.error().to_line();
}

TEST(Rawlog, UnknownClassesVersionsAndOldHeadersAreUnsupportedOrMalformed) {
  std::string bytes = *rawlog_bytes(small_log());
  const auto code_of = [](const std::string& changed) {
    return check_rawlog_frames(changed, "a").error().code;
  };
  std::string other_class = bytes;
  other_class[bytes.find("CObservationIMU") + 12] = 'X';
  EXPECT_EQ(code_of(other_class), ErrorCode::kUnsupported);
  std::string other_version = bytes;
  other_version[bytes.find("CObservationIMU") + 15] = 9;
  EXPECT_EQ(code_of(other_version), ErrorCode::kUnsupported);
  EXPECT_EQ(code_of("garbage"), ErrorCode::kMalformed);
  EXPECT_EQ(code_of(std::string(1000, '\xff')), ErrorCode::kMalformed);
}

TEST(Rawlog, EmptyOrGarbageFilesAreOneLineErrors) {
  const ScratchFolder folder;
  for (const std::string& content : {std::string(), std::string("garbage\n"), std::string("\0", 1),
                                     *gzip(""), *gzip("more garbage")}) {
    write_text(folder / "a.rawlog", content);
    const auto read = read_log(folder / "a.rawlog");
    ASSERT_FALSE(read.has_value());
    EXPECT_TRUE(contains(read.error(), "a.rawlog"));
    EXPECT_EQ(read.error().to_line().find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace corridor::formats
