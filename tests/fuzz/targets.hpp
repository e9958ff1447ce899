// What is fuzzed: one function per reader, each in a file of its own. It reads the bytes as that
// reader's file and says whether they were taken; it must come back for any bytes whatever.
#pragma once

#include <string_view>

namespace corridor::fuzz {

bool bag(std::string_view bytes);
bool bag_chunk(std::string_view bytes);
bool bag_framing(std::string_view bytes);
bool carmen(std::string_view bytes);
bool carmen_trajectory(std::string_view bytes);
bool catalog(std::string_view bytes);
bool euroc(std::string_view bytes);
bool gzip(std::string_view bytes);
bool kitti(std::string_view bytes);
bool lcm(std::string_view bytes);
bool pose_graph(std::string_view bytes);
bool rawlog(std::string_view bytes);
bool rawlog_framing(std::string_view bytes);
bool relations(std::string_view bytes);
bool robot_toml(std::string_view bytes);
bool ros_map(std::string_view bytes);
bool scenario(std::string_view bytes);
bool ticks(std::string_view bytes);
bool topics(std::string_view bytes);
bool true_poses(std::string_view bytes);
bool truth(std::string_view bytes);
bool tum(std::string_view bytes);
bool world(std::string_view bytes);

}  // namespace corridor::fuzz
