// One message of a ROS 1 bag as an event of the suite. Internal to this folder.
#pragma once

#include <optional>
#include <string>

#include "datasets/formats/bag/bag_topics.hpp"
#include "datasets/formats/bag/rosbag_door.hpp"
#include "datasets/formats/parsed_log.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

class BagMessageReader {
 public:
  // What is left out or replaced is counted in `log`, which outlives the reader.
  BagMessageReader(const std::optional<WheelJoints>& joints, ParsedLog& log)
      : joints_(joints), log_(log) {}

  // nullopt: nothing the suite can use, counted. `where` names the message in an Error.
  Result<std::optional<SensorEvent>> take(const ros1::Message& message, const std::string& where);

 private:
  using Taken = Result<std::optional<SensorEvent>>;

  Taken take_scan(const ros1::Scan& scan, Timestamp stamp, const std::string& where);
  Result<void> take_beams(const ros1::Scan& scan, const std::string& where, LaserScan& taken);
  void keep_limits(const ros1::Scan& scan);
  Taken take_odometry(const ros1::Odometry& odometry, Timestamp stamp, const std::string& where);
  Taken take_imu(const ros1::Imu& imu, Timestamp stamp, const std::string& where);
  Taken take_joints(const ros1::Joints& joints, Timestamp stamp, const std::string& where);

  const std::optional<WheelJoints>& joints_;
  ParsedLog& log_;
};

}  // namespace corridor::formats
