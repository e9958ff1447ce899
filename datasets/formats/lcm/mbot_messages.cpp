#include "datasets/formats/lcm/mbot_messages.hpp"

#include <fmt/format.h>

#include "datasets/formats/byte_walker.hpp"
#include "datasets/formats/parsed_log.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr std::uint64_t kScanFingerprint = 0x89dc5b879a5056cf;
constexpr std::uint64_t kTicksFingerprint = 0x8dc5a028fca42ff9;
constexpr std::uint64_t kImuFingerprint = 0xc320824c265e849a;
constexpr std::uint64_t kPoseFingerprint = 0x1f317af1246276ac;
constexpr std::size_t kMotorValuesBytes = 24;
constexpr std::size_t kOtherReadingsBytes = 24 + 18;  // gyro integrals, then nine i16
constexpr std::size_t kBytesPerBeam = 4 + 4 + 8 + 4;
// The year 2096: far from what int64 nanoseconds hold, so that sums of stamps do not overflow.
constexpr std::int64_t kMaxStamp_us = 4'000'000'000'000'000;

ByteWalker walk(const LcmEvent& event, const std::string& file, std::uint64_t fingerprint) {
  ByteWalker walker(event.data, file, event.data_begin);
  const auto found = walker.take<std::uint64_t>("a message's fingerprint");
  if (found != fingerprint) {
    walker.refuse(event.data_begin,
                  fmt::format("fingerprint {:016x} on channel {}", found, quote(event.channel)),
                  fmt::format("{:016x}, the layout this version reads", fingerprint));
  }
  return walker;
}

std::int64_t take_stamp(ByteWalker& walker) {
  const std::size_t at = walker.offset();
  const auto stamp_us = walker.take<std::int64_t>("stamps");
  if (stamp_us < 0 || stamp_us > kMaxStamp_us) {
    walker.refuse(at, fmt::format("stamp of {} us", stamp_us), fmt::format("0 to {}", kMaxStamp_us),
                  ErrorCode::kInvalid);
  }
  return stamp_us;
}

// Every message must end where its layout does.
template <class T>
Result<T> finish(ByteWalker& walker, const LcmEvent& event, T message) {
  if (!walker.at_end()) {
    walker.refuse(walker.offset(),
                  fmt::format("{} bytes too many in a message on channel {}", walker.num_left(),
                              quote(event.channel)),
                  "the message's end");
  }
  if (walker.has_failed()) return tl::make_unexpected(walker.error());
  return message;
}

template <class T>
std::vector<T> take_list(ByteWalker& walker, std::size_t count, std::string_view what) {
  std::vector<T> list(count);
  for (T& value : list) value = walker.take<T>(what);
  return list;
}

// Capped, and compared with the bytes that are there, before anything is allocated.
std::size_t take_num_beams(ByteWalker& walker) {
  const std::size_t at = walker.offset();
  const auto num_beams = walker.take<std::int32_t>("a number of beams");
  if (num_beams < 1 || static_cast<std::size_t>(num_beams) > kMaxBeams) {
    walker.refuse(at, fmt::format("number of beams is {}", num_beams),
                  fmt::format("1 to {}", kMaxBeams));
    return 0;
  }
  const auto count = static_cast<std::size_t>(num_beams);
  if (walker.num_left() != count * kBytesPerBeam) {
    walker.refuse(at, fmt::format("{} beams in {} bytes of readings", num_beams, walker.num_left()),
                  fmt::format("{} bytes", count * kBytesPerBeam));
    return 0;
  }
  return count;
}

}  // namespace

Result<MbotScan> decode_scan(const LcmEvent& event, const std::string& file) {
  ByteWalker walker = walk(event, file, kScanFingerprint);
  MbotScan scan;
  scan.stamp_us = take_stamp(walker);
  const std::size_t num_beams = take_num_beams(walker);
  scan.ranges_m = take_list<float>(walker, num_beams, "ranges");
  scan.angles_rad = take_list<float>(walker, num_beams, "angles");
  for (std::size_t beam = 0; beam < num_beams; ++beam) scan.times_us.push_back(take_stamp(walker));
  walker.take_bytes(num_beams * sizeof(float), "intensities");
  return finish(walker, event, std::move(scan));
}

Result<MbotTicks> decode_ticks(const LcmEvent& event, const std::string& file) {
  ByteWalker walker = walk(event, file, kTicksFingerprint);
  MbotTicks ticks;
  ticks.stamp_us = take_stamp(walker);
  ticks.left = walker.take<std::int32_t>("left ticks");
  ticks.right = walker.take<std::int32_t>("right ticks");
  walker.take_bytes(kMotorValuesBytes, "motor values");
  return finish(walker, event, ticks);
}

Result<MbotImu> decode_imu(const LcmEvent& event, const std::string& file) {
  ByteWalker walker = walk(event, file, kImuFingerprint);
  MbotImu imu;
  imu.stamp_us = take_stamp(walker);
  for (auto& value : imu.accel_lsb) value = walker.take<std::int16_t>("accelerations");
  for (auto& value : imu.gyro_lsb) value = walker.take<std::int16_t>("turn rates");
  walker.take_bytes(kOtherReadingsBytes, "other readings");
  return finish(walker, event, imu);
}

Result<MbotPose> decode_pose(const LcmEvent& event, const std::string& file) {
  ByteWalker walker = walk(event, file, kPoseFingerprint);
  MbotPose pose;
  pose.stamp_us = take_stamp(walker);
  pose.x_m = walker.take<float>("x");
  pose.y_m = walker.take<float>("y");
  pose.theta_rad = walker.take<float>("theta");
  return finish(walker, event, pose);
}

}  // namespace corridor::formats
