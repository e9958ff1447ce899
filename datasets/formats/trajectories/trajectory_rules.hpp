// What every trajectory format asks of its poses: a rotation in the plane, stamps that increase,
// stamps in the format's unit. Internal to this folder.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "slam/core/result.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::formats {

// Finite numbers of `fields`, all of them; the Error names the field.
Result<void> parse_finite(std::span<const std::string_view> fields, const std::string& where,
                          std::span<double> numbers);

// Yaw [rad] of a rotation about z. An Error for a length other than 1 (within 1e-3: files have few
// decimals; zero is none) and for roll or pitch beyond 1e-6 rad.
Result<double> yaw_of_quaternion(double qx, double qy, double qz, double qw,
                                 const std::string& where);

// An Error that quotes `stamp_text` if the stamp is not later than the last.
Result<void> append_pose(Trajectory& trajectory, Timestamp stamp, const Pose2& T_map_base,
                         std::string_view stamp_text, const std::string& where);

// An Error if the median step of at least five poses lies outside [1e-6 s, 10 s]: milliseconds read
// as seconds, or seconds as nanoseconds, match nothing and would score as perfect.
Result<void> check_stamp_unit(const Trajectory& trajectory, const std::string& name,
                              std::string_view unit);

}  // namespace corridor::formats
