// What the raw numbers and stamps of a log mean, for formats that hold no physical units: the table
// [raw] of LOG.robot.toml and of a catalogue entry's calibration.
#pragma once

namespace corridor::formats {

enum class RawClock {
  kData,         // "data": all sensors stamp with one clock
  kEventOffset,  // "event-offset": wheels and IMU count from a start of their own; the events'
                 // times lead from there to the LiDAR's clock, which is the logger's
  kScanRate,  // "scan-rate": the LiDAR turns at a constant rate; its scans lie on the line through
              // the stamps of the program that read it, early or late
};

struct RawSensors {
  RawClock clock = RawClock::kData;
  bool is_lidar_clockwise = true;    // lidar_angles = "clockwise" | "counter-clockwise", from above
  double accel_lsb_per_g = 16'384;   // full scale of 2 g in 16 bits
  double gyro_lsb_per_dps = 131.07;  // full scale of 250 deg/s in 16 bits
};

}  // namespace corridor::formats
