#include <fmt/format.h>

#include "bench/cli/conversions.hpp"
#include "bench/cli/staged_files.hpp"
#include "bench/runner/exit_code.hpp"
#include "datasets/catalog/load_graph.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "slam/core/counted.hpp"

namespace corridor::cli {

Result<ExitCode> convert_graph(const std::string& in, const std::filesystem::path& out,
                               const CommonOptions& common) {
  const auto target = formats::graph_format_from_suffix(out);
  if (!target) {
    return fail(ErrorCode::kUnsupported, "a pose graph becomes a pose graph only", out.string(),
                ".g2o, .graph or .toro");
  }
  if (const Result<void> good = check_targets({out}); !good)
    return tl::make_unexpected(good.error());
  const Result<catalog::Catalog> known = catalog::known_datasets(common.data_dirs());
  if (!known) return tl::make_unexpected(known.error());
  const auto loaded = catalog::load_graph(in, common.data_dirs(), *known);
  if (!loaded) return tl::make_unexpected(loaded.error());
  const formats::PoseGraph& graph = loaded->graph;
  if (const Result<void> written = formats::write_pose_graph(graph, out); !written) {
    return tl::make_unexpected(written.error());
  }
  for (const std::string& note : graph.notes) common.say("note: " + note);
  const auto losses = formats::losses_of_conversion(graph, *target);
  for (const std::string& loss : losses) common.say("lost: " + loss);
  common.say(fmt::format("{}: {}, {}{}", out.string(), counted(graph.vertices.size(), "pose"),
                         counted(graph.edges.size(), "edge"),
                         losses.empty() ? ", nothing lost" : ""));
  return runner::kExitDone;
}

}  // namespace corridor::cli
