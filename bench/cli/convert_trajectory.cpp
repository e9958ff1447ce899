#include <fmt/format.h>

#include <vector>

#include "bench/cli/conversions.hpp"
#include "bench/cli/staged_files.hpp"
#include "bench/runner/exit_code.hpp"
#include "datasets/formats/trajectories/trajectory_io.hpp"

namespace corridor::cli {
namespace {

using formats::TrajectoryFormat;

// OUT, and the stamps beside it where OUT holds none.
std::vector<std::filesystem::path> targets_of(const std::filesystem::path& out,
                                              TrajectoryFormat format) {
  if (format != TrajectoryFormat::kKitti) return {out};
  return {out, formats::times_beside(out)};
}

Result<void> write_whole(const Trajectory& trajectory, const std::filesystem::path& out) {
  Result<StagedFiles> staged = StagedFiles::beside(out);
  if (!staged) return tl::make_unexpected(staged.error());
  const Result<void> written = formats::write_trajectory(trajectory, staged->path_for(out));
  if (!written) return tl::make_unexpected(staged->with_final_name(written.error()));
  return staged->commit();
}

}  // namespace

Result<ExitCode> convert_trajectory(const std::filesystem::path& in,
                                    const std::filesystem::path& out, const CommonOptions& common) {
  const auto target = formats::trajectory_format_from_suffix(out);
  if (!target) {
    return fail(ErrorCode::kUnsupported, "a trajectory becomes a trajectory only", out.string(),
                ".tum, .kitti, .csv, .clf or .clf.gz");
  }
  if (const Result<void> good = check_targets(targets_of(out, *target)); !good) {
    return tl::make_unexpected(good.error());
  }
  const auto read = formats::read_trajectory(in);
  if (!read) return tl::make_unexpected(read.error());
  if (const Result<void> written = write_whole(read->trajectory, out); !written) {
    return tl::make_unexpected(written.error());
  }
  for (const std::string& note : read->notes) common.say("note: " + note);
  const auto losses = formats::losses_of_conversion(read->trajectory, *target);
  for (const std::string& loss : losses) common.say("lost: " + loss);
  common.say(fmt::format("{}: {} poses{}", out.string(), read->trajectory.size(),
                         losses.empty() ? ", nothing lost" : ""));
  return runner::kExitDone;
}

}  // namespace corridor::cli
