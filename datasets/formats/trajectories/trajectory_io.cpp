#include "datasets/formats/trajectories/trajectory_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/trajectories/trajectory_texts.hpp"
#include "datasets/formats/trajectories/tum.hpp"

namespace corridor::formats {
namespace {

constexpr std::array<std::pair<std::string_view, TrajectoryFormat>, 5> kSuffixes = {
    {{".tum", TrajectoryFormat::kTum},
     {".kitti", TrajectoryFormat::kKitti},
     {".csv", TrajectoryFormat::kEuroc},
     {".clf", TrajectoryFormat::kCarmen},
     {".clf.gz", TrajectoryFormat::kCarmen}}};

tl::unexpected<Error> unknown_suffix(const std::filesystem::path& path) {
  return fail(ErrorCode::kUnsupported, "unknown kind of trajectory", path.string(),
              "a name that ends in .tum, .kitti, .csv, .clf or .clf.gz");
}

Result<ReadTrajectory> read_kitti(const std::string& poses, const std::filesystem::path& path) {
  const std::filesystem::path times_path = times_beside(path);
  std::error_code ignored;
  if (!std::filesystem::exists(times_path, ignored)) {
    return fail(ErrorCode::kNotFound, "a KITTI trajectory has no stamps", path.string(),
                times_path.string() + " with one stamp in seconds a line");
  }
  const auto times = read_file_bytes(times_path);
  if (!times) return tl::make_unexpected(times.error());
  return parse_kitti(poses, path.string(), *times, times_path.string());
}

std::string text_of(const Trajectory& trajectory, TrajectoryFormat format) {
  switch (format) {
    case TrajectoryFormat::kTum:
      return tum_text(trajectory);
    case TrajectoryFormat::kKitti:
      return kitti_text(trajectory);
    case TrajectoryFormat::kEuroc:
      return euroc_text(trajectory);
    case TrajectoryFormat::kCarmen:
      return carmen_trajectory_text(trajectory);
  }
  return {};
}

}  // namespace

std::string_view to_text(TrajectoryFormat format) {
  constexpr std::array<std::string_view, 4> kNames = {"TUM", "KITTI", "EuRoC", "CARMEN"};
  return kNames[static_cast<std::size_t>(format)];
}

std::optional<TrajectoryFormat> trajectory_format_from_suffix(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  for (const auto& [suffix, format] : kSuffixes) {
    if (name.ends_with(suffix)) return format;
  }
  return std::nullopt;
}

std::filesystem::path times_beside(const std::filesystem::path& kitti) {
  return std::filesystem::path(kitti).replace_extension(".times");
}

Result<ReadTrajectory> read_trajectory(const std::filesystem::path& path) {
  const auto format = trajectory_format_from_suffix(path);
  if (!format) return unknown_suffix(path);
  const auto text = read_file_bytes(path);
  if (!text) return tl::make_unexpected(text.error());
  auto read = *format == TrajectoryFormat::kTum     ? parse_tum_trajectory(*text, path.string())
              : *format == TrajectoryFormat::kKitti ? read_kitti(*text, path)
              : *format == TrajectoryFormat::kEuroc ? parse_euroc(*text, path.string())
                                                    : parse_carmen_trajectory(*text, path.string());
  if (read && read->trajectory.empty()) {
    return fail(ErrorCode::kMalformed, "the trajectory has no pose", path.string(),
                fmt::format("{} poses", to_text(*format)));
  }
  return read;
}

Result<void> write_trajectory(const Trajectory& trajectory, const std::filesystem::path& path) {
  const auto format = trajectory_format_from_suffix(path);
  if (!format) return unknown_suffix(path);
  std::string text = text_of(trajectory, *format);
  if (path.extension() == ".gz") {
    auto compressed = gzip(text);
    if (!compressed) return tl::make_unexpected(compressed.error());
    text = std::move(*compressed);
  }
  if (auto written = write_file_atomically(path, text); !written) return written;
  if (*format != TrajectoryFormat::kKitti) return {};
  return write_file_atomically(times_beside(path), times_text(trajectory));
}

std::vector<std::string> losses_of_conversion(const Trajectory& trajectory,
                                              TrajectoryFormat target) {
  std::vector<std::string> losses;
  const auto num_covariances =
      std::count_if(trajectory.poses().begin(), trajectory.poses().end(),
                    [](const TrajectoryPose& pose) { return pose.covariance_base.has_value(); });
  if (num_covariances > 0) losses.push_back(fmt::format("{} covariances", num_covariances));
  if (target == TrajectoryFormat::kKitti) {
    losses.push_back(
        fmt::format("{} stamps, but for the file .times beside it", trajectory.size()));
  }
  if (target == TrajectoryFormat::kCarmen) return losses;
  const auto is_turned = [](const TrajectoryPose& pose) {
    return pose.T_map_base.theta_rad() != 0;
  };
  if (std::any_of(trajectory.poses().begin(), trajectory.poses().end(), is_turned)) {
    losses.emplace_back("the last digit of angles: they are kept as sine and cosine");
  }
  return losses;
}

}  // namespace corridor::formats
