#include "datasets/formats/bag/bag_layouts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "datasets/formats/parsed_log.hpp"

namespace corridor::formats {
namespace {

// MD5 sums of the definitions, as rosmsg gives them for ROS Noetic.
constexpr std::array<BagTypeInfo, 4> kTypes = {{
    {BagType::kLaserScan, "sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369"},
    {BagType::kOdometry, "nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7"},
    {BagType::kImu, "sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2"},
    {BagType::kJointState, "sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd"},
}};

constexpr std::uint32_t kMaxNameBytes = 1024;
constexpr std::uint32_t kMaxJoints = 1024;
constexpr std::uint32_t kNanoseconds = 1'000'000'000;
// Numbers behind the header: quaternion and three vectors with 3x3 covariances (Imu); pose and
// twist with 6x6 covariances (Odometry).
constexpr std::size_t kImuBytes = 8 * (4 + 9 + 3 + 9 + 3 + 9);
constexpr std::size_t kOdometryBytes = 8 * (7 + 36 + 6 + 36);
constexpr std::size_t kScanBytes = 4 * 7;

// Walks along one message. The first violation is kept; every step after it does nothing.
class MessageWalker {
 public:
  MessageWalker(const BagBytes& from, std::size_t begin, std::size_t end)
      : from_(from), offset_(begin), end_(end) {}

  void skip(std::size_t num_bytes, const char* what) {
    if (error_) return;
    if (num_bytes > end_ - offset_) {
      refuse(fmt::format("the message ends inside {}", what),
             fmt::format("{} bytes, {} are left", num_bytes, end_ - offset_));
      return;
    }
    offset_ += num_bytes;
  }

  std::uint32_t number(const char* what) {
    const std::size_t begin = offset_;
    skip(sizeof(std::uint32_t), what);
    return error_ ? 0 : u32_at(from_.bytes, begin);
  }

  std::uint32_t count(std::uint32_t max, const char* what) {
    const std::uint32_t n = number(what);
    if (n > max) refuse(fmt::format("{} is {}", what, n), fmt::format("at most {}", max));
    return error_ ? 0 : n;
  }

  void text(const char* what) { skip(count(kMaxNameBytes, what), what); }

  // std_msgs/Header: sequence number, stamp, frame.
  void header() {
    number("the header");
    number("the header's stamp");
    const std::uint32_t nanoseconds = number("the header's stamp");
    if (nanoseconds >= kNanoseconds) {
      refuse(fmt::format("the header's stamp has {} nanoseconds", nanoseconds),
             "less than a second of them");
    }
    text("the header's frame");
  }

  Result<void> finish() {
    if (!error_ && offset_ != end_) {
      refuse(fmt::format("{} bytes follow the message", end_ - offset_), "its end");
    }
    if (error_) return tl::make_unexpected(*error_);
    return {};
  }

 private:
  void refuse(std::string what, std::string expected) {
    if (error_) return;
    error_ = Error{ErrorCode::kMalformed, std::move(what), from_.at(offset_), std::move(expected)};
  }

  const BagBytes& from_;
  std::size_t offset_;
  std::size_t end_;
  std::optional<Error> error_;
};

void walk_scan(MessageWalker& walker) {
  walker.skip(kScanBytes, "a scan's angles and limits");
  constexpr auto kMax = static_cast<std::uint32_t>(kMaxBeams);
  walker.skip(sizeof(float) * walker.count(kMax, "number of ranges"), "a scan's ranges");
  walker.skip(sizeof(float) * walker.count(kMax, "number of intensities"), "intensities");
}

void walk_joints(MessageWalker& walker) {
  const std::uint32_t num_names = walker.count(kMaxJoints, "number of joints");
  for (std::uint32_t i = 0; i < num_names; ++i) walker.text("a joint's name");
  for (const char* what : {"joint positions", "joint velocities", "joint efforts"}) {
    walker.skip(sizeof(double) * walker.count(kMaxJoints, what), what);
  }
}

}  // namespace

std::optional<BagTypeInfo> bag_type_of(std::string_view name) {
  const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                  [&](const BagTypeInfo& info) { return info.name == name; });
  if (found == kTypes.end()) return std::nullopt;
  return *found;
}

const BagTypeInfo& bag_type_info(BagType type) { return kTypes[static_cast<std::size_t>(type)]; }

Result<void> check_message_layout(BagType type, const BagBytes& from, std::size_t begin,
                                  std::size_t end) {
  MessageWalker walker(from, begin, end);
  walker.header();
  switch (type) {
    case BagType::kLaserScan:
      walk_scan(walker);
      break;
    case BagType::kOdometry:
      walker.text("the child's frame");
      walker.skip(kOdometryBytes, "the odometry");
      break;
    case BagType::kImu:
      walker.skip(kImuBytes, "the IMU reading");
      break;
    case BagType::kJointState:
      walk_joints(walker);
      break;
  }
  return walker.finish();
}

}  // namespace corridor::formats
