#include "bench/cli/convert_command.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <filesystem>
#include <system_error>

#include "bench/cli/conversions.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/formats/trajectories/trajectory_io.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

bool is_graph(const fs::path& path) { return formats::graph_format_from_suffix(path).has_value(); }

// CARMEN files are logs that hold a trajectory too; which is meant, the other side says.
bool is_trajectory_only(const fs::path& path) {
  return formats::trajectory_format_from_suffix(path) && !formats::format_from_suffix(path);
}

bool is_carmen(const fs::path& path) {
  return formats::trajectory_format_from_suffix(path) == formats::TrajectoryFormat::kCarmen;
}

Result<void> check_names(const fs::path& in, const fs::path& out) {
  std::error_code ignored;
  if (fs::equivalent(in, out, ignored)) {
    return fail(ErrorCode::kInvalid, "this is the file that is read", out.string(), "another name");
  }
  return check_parent_folder(out);
}

}  // namespace

void ConvertCommand::add_to(CLI::App& command) {
  command.add_option("in", in, "Log, name of a data set, trajectory or pose graph")
      ->required()
      ->type_name("IN");
  command
      .add_option("out", out,
                  "Log (" + formats::writable_suffixes() +
                      "; truth and world go beside it), trajectory (.tum .kitti .csv .clf .clf.gz) "
                      "or pose graph (.g2o .graph .toro)")
      ->required()
      ->type_name("OUT");
  command.add_flag(
      "--accept-other-checksum", accept_other_checksum,
      "Take a data set's log although its files are not the catalogue's: for canonical "
      "versions of derived logs");
  common.add_to(command);
}

Result<ExitCode> ConvertCommand::run() const {
  if (const Result<void> good = check_names(in, out); !good) {
    return tl::make_unexpected(good.error());
  }
  // The name of a graph in the catalogue has no suffix; what becomes of it has.
  const bool is_name = !fs::path(in).has_extension() && is_graph(out);
  if (is_graph(in) || is_name) return convert_graph(in, out, common);
  const bool takes_poses = is_carmen(in) && is_trajectory_only(out);
  if (is_trajectory_only(in) || takes_poses) return convert_trajectory(in, out, common);
  return convert_log(in, out, accept_other_checksum, common);
}

}  // namespace corridor::cli
