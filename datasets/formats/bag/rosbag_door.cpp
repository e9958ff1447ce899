#include "datasets/formats/bag/rosbag_door.hpp"

#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <memory>
#include <utility>

namespace corridor::formats::ros1 {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr double kNotMeasured = -1;

std::int64_t nanoseconds_of(const ros::Time& time) {
  return static_cast<std::int64_t>(time.sec) * kSecond_ns + time.nsec;
}

ros::Time ros_time(std::int64_t nanoseconds) {
  return {static_cast<std::uint32_t>(nanoseconds / kSecond_ns),
          static_cast<std::uint32_t>(nanoseconds % kSecond_ns)};
}

template <class Numbers>
bool says_something(const Numbers& numbers) {
  return std::any_of(numbers.begin(), numbers.end(), [](double number) { return number != 0; });
}

// Of a covariance whose first number may say that nothing was measured.
template <class Numbers>
bool is_measured(const Numbers& covariance) {
  return covariance[0] != kNotMeasured && says_something(covariance);
}

bool says_something(const geometry_msgs::Vector3& vector) {
  return vector.x != 0 || vector.y != 0 || vector.z != 0;
}

Scan content_of(const sensor_msgs::LaserScan& scan) {
  return {scan.angle_min, scan.angle_max, scan.angle_increment, scan.time_increment, scan.range_min,
          scan.range_max, scan.ranges,    scan.intensities,     scan.scan_time};
}

Odometry content_of(const nav_msgs::Odometry& odometry) {
  const auto& pose = odometry.pose.pose;
  const auto& twist = odometry.twist;
  const bool has_more = pose.position.z != 0 || says_something(odometry.pose.covariance) ||
                        says_something(twist.twist.linear) || says_something(twist.twist.angular) ||
                        says_something(twist.covariance);
  return {pose.position.x,
          pose.position.y,
          pose.orientation.x,
          pose.orientation.y,
          pose.orientation.z,
          pose.orientation.w,
          has_more};
}

Imu content_of(const sensor_msgs::Imu& imu) {
  const bool has_more = imu.angular_velocity.x != 0 || imu.angular_velocity.y != 0 ||
                        imu.linear_acceleration.z != 0 ||
                        imu.orientation_covariance[0] != kNotMeasured ||
                        is_measured(imu.angular_velocity_covariance) ||
                        is_measured(imu.linear_acceleration_covariance);
  return {imu.angular_velocity.z,
          imu.linear_acceleration.x,
          imu.linear_acceleration.y,
          imu.angular_velocity_covariance[0] != kNotMeasured,
          imu.linear_acceleration_covariance[0] != kNotMeasured,
          has_more};
}

Joints content_of(const sensor_msgs::JointState& joints) {
  return {joints.name, joints.position,
          says_something(joints.velocity) || says_something(joints.effort)};
}

template <class T>
bool take(const rosbag::MessageInstance& instance, std::vector<Message>& messages) {
  if (!instance.isType<T>()) return false;
  const auto message = instance.instantiate<T>();
  if (message == nullptr) return false;
  messages.push_back({instance.getTopic(), nanoseconds_of(instance.getTime()),
                      nanoseconds_of(message->header.stamp), content_of(*message)});
  return true;
}

sensor_msgs::LaserScan ros_message(const Scan& scan) {
  sensor_msgs::LaserScan message;
  message.header.frame_id = "laser";
  message.angle_min = scan.angle_min_rad;
  message.angle_max = scan.angle_max_rad;
  message.angle_increment = scan.angle_increment_rad;
  message.time_increment = scan.time_increment_s;
  message.range_min = scan.range_min_m;
  message.range_max = scan.range_max_m;
  message.ranges = scan.ranges_m;
  message.intensities = scan.intensities;
  message.scan_time = scan.scan_time_s;
  return message;
}

nav_msgs::Odometry ros_message(const Odometry& odometry) {
  nav_msgs::Odometry message;
  message.header.frame_id = "odom";
  message.child_frame_id = "base_link";
  message.pose.pose.position.x = odometry.x_m;
  message.pose.pose.position.y = odometry.y_m;
  message.pose.pose.orientation.x = odometry.qx;
  message.pose.pose.orientation.y = odometry.qy;
  message.pose.pose.orientation.z = odometry.qz;
  message.pose.pose.orientation.w = odometry.qw;
  return message;
}

sensor_msgs::Imu ros_message(const Imu& imu) {
  sensor_msgs::Imu message;
  message.header.frame_id = "imu";
  message.orientation.w = 1;
  message.orientation_covariance[0] = kNotMeasured;
  message.angular_velocity.z = imu.gyro_z_radps;
  message.linear_acceleration.x = imu.accel_x_mps2;
  message.linear_acceleration.y = imu.accel_y_mps2;
  if (!imu.has_gyro) message.angular_velocity_covariance[0] = kNotMeasured;
  if (!imu.has_accel) message.linear_acceleration_covariance[0] = kNotMeasured;
  return message;
}

sensor_msgs::JointState ros_message(const Joints& joints) {
  sensor_msgs::JointState message;
  message.name = joints.names;
  message.position = joints.positions_rad;
  return message;
}

rosbag::CompressionType rosbag_compression(Compression compression) {
  if (compression == Compression::kBz2) return rosbag::compression::BZ2;
  return compression == Compression::kLz4 ? rosbag::compression::LZ4
                                          : rosbag::compression::Uncompressed;
}

void write_all(rosbag::Bag& bag, const std::vector<Message>& messages) {
  for (const Message& message : messages) {
    std::visit(
        [&](const auto& content) {
          auto written = ros_message(content);
          written.header.stamp = ros_time(message.stamp_ns);
          bag.write(message.topic, ros_time(message.record_ns), written);
        },
        message.content);
  }
}

}  // namespace

Result<std::vector<Message>> read_messages(const std::string& path,
                                           const std::vector<std::string>& topics) {
  std::vector<Message> messages;
  try {
    rosbag::Bag bag(path, rosbag::bagmode::Read);
    rosbag::View view(bag, rosbag::TopicQuery(topics));
    for (const rosbag::MessageInstance& instance : view) {
      const bool is_taken = take<sensor_msgs::LaserScan>(instance, messages) ||
                            take<nav_msgs::Odometry>(instance, messages) ||
                            take<sensor_msgs::Imu>(instance, messages) ||
                            take<sensor_msgs::JointState>(instance, messages);
      if (!is_taken) {
        return fail(ErrorCode::kUnsupported,
                    "topic " + instance.getTopic() + " of type " + instance.getDataType(), path,
                    "LaserScan, Odometry, Imu or JointState");
      }
    }
  } catch (const std::exception& error) {
    return fail(ErrorCode::kMalformed, std::string("rosbag cannot read it: ") + error.what(), path,
                "a bag rosbag 1.15 reads");
  }
  return messages;
}

Result<void> write_messages(const std::string& path, const std::vector<Message>& messages,
                            Compression compression, std::uint32_t chunk_bytes) {
  auto bag = std::make_unique<rosbag::Bag>();
  // rosbag tells how many bytes were not written, the system why.
  errno = 0;
  try {
    bag->open(path, rosbag::bagmode::Write);
    bag->setCompression(rosbag_compression(compression));
    bag->setChunkThreshold(chunk_bytes);
    write_all(*bag, messages);
    bag->close();
  } catch (const std::exception& error) {
    const int reason = errno;
    // Never destroyed: its destructor writes what is left, and throws where that fails again, which
    // would end the program.
    static_cast<void>(bag.release());
    return fail(
        ErrorCode::kUnreadable,
        std::string("cannot be written: ") + (reason != 0 ? std::strerror(reason) : error.what()),
        path);
  }
  return {};
}

}  // namespace corridor::formats::ros1
