// The recorded corridor logs as parameters of tests, and what the original programs made of them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "slam/core/pose2.hpp"

namespace corridor::testing {

inline constexpr std::array<const char*, 9> kCorridorLogs = {
    "r12-s1",  "r4.5-s1", "r4.5-s2",      "r4.5-s3",     "r4.5-s4",
    "r4.5-s5", "r4.5-s6", "r4.5-slip-s7", "r4.5-vary-s8"};

// A log's name as that of a test.
inline std::string test_name(const ::testing::TestParamInfo<const char*>& log) {
  std::string name = log.param;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

struct OriginalPose {
  Pose2 T_odom_base;
  bool is_key_scan = false;
};

// Lines "stamp x_m y_m theta_rad is_key_scan", one per scan.
inline std::vector<OriginalPose> read_original_poses(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<OriginalPose> poses;
  double stamp_s = 0;
  double x_m = 0;
  double y_m = 0;
  double theta_rad = 0;
  int is_key_scan = 0;
  while (in >> stamp_s >> x_m >> y_m >> theta_rad >> is_key_scan) {
    poses.push_back({Pose2(x_m, y_m, theta_rad), is_key_scan != 0});
  }
  return poses;
}

}  // namespace corridor::testing
