#include "tests/datasets/formats/bag_support.hpp"

#include <stdexcept>

#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats::test {
namespace {

constexpr std::int64_t kBegin_ns = 100'000'000'000;
constexpr std::int64_t kDelay_ns = 1'000'000;
constexpr std::uint32_t kChunkBytes = 2048;

double seconds_since_begin(std::int64_t stamp_ns) {
  return static_cast<double>(stamp_ns - kBegin_ns) * 1e-9;
}

}  // namespace

ros1::Message scan_message(std::int64_t stamp_ns) {
  ros1::Scan scan;
  scan.angle_min_rad = -0.5F;
  scan.angle_max_rad = 0.5F;
  scan.angle_increment_rad = 0.25F;
  scan.range_min_m = 0.125F;
  scan.range_max_m = 4.5F;
  scan.ranges_m = {1, 1.5F, 5.5F, 2, 2.5F};
  return {"/scan", stamp_ns + kDelay_ns, stamp_ns, scan};
}

ros1::Message odometry_message(std::int64_t stamp_ns) {
  return {"/odom", stamp_ns + kDelay_ns, stamp_ns,
          ros1::Odometry{0.5 * seconds_since_begin(stamp_ns), 0, 0, 0, 0, 1}};
}

ros1::Message imu_message(std::int64_t stamp_ns) {
  return {"/imu", stamp_ns + kDelay_ns, stamp_ns, ros1::Imu{0.01, 0.25, -0.5, true, true}};
}

std::vector<ros1::Message> small_bag() {
  std::vector<ros1::Message> messages;
  for (int step = 0; step <= 20; ++step) {
    const std::int64_t stamp_ns = kBegin_ns + 20'000'000LL * step;
    messages.push_back(odometry_message(stamp_ns));
    messages.push_back(imu_message(stamp_ns));
    if (step % 5 == 0) messages.push_back(scan_message(stamp_ns));
  }
  return messages;
}

void write_bag(const std::filesystem::path& path, const std::vector<ros1::Message>& messages,
               ros1::Compression compression) {
  const auto written = ros1::write_messages(path.string(), messages, compression, kChunkBytes);
  if (!written) throw std::runtime_error(written.error().to_line());
}

std::string bag_bytes(const std::vector<ros1::Message>& messages, ros1::Compression compression) {
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages, compression);
  return read_text(folder / "a.bag");
}

}  // namespace corridor::formats::test
