// Solves a pose graph of a file with any back-end, all at once or pose by pose, and measures what
// that took. It reads and writes no files and knows no back-end by name.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/backend/back_end.hpp"
#include "slam/core/result.hpp"
#include "slam/graph/robust_kernel.hpp"

namespace corridor::solve {

enum class Mode { kBatch, kIncremental };
enum class Initialization { kFile, kOdometry, kChordal };

// What one update of kIncremental did.
struct Update {
  std::uint32_t newest = 0;  // pose, and where the estimate had it right after the update
  Pose2 T_map_newest;
  std::size_t num_poses = 0;  // so far
  std::int64_t num_relinearized = 0;
  std::int64_t num_eliminated = 0;
};

struct SolveOptions {
  Mode mode = Mode::kBatch;
  Initialization init = Initialization::kFile;  // of kBatch
  int poses_per_update = 1;                     // of kIncremental
  graph::RobustKernel kernel = {};              // of every edge
  // Of kIncremental: called after every update, with its own clock stopped. For replays: total_s,
  // cpu_s and the memory have in them what it does.
  std::function<void(const backend::BackEnd&, const Update&)> after_update = {};
};

struct SolveRun {
  // Of kIncremental: of the last update. The words are those of backend::to_text().
  backend::SolveStatus status = backend::SolveStatus::kEmpty;
  std::string status_message;  // what the status does not say; empty for nothing
  // Sums over all updates.
  std::int64_t num_iterations = 0;
  std::int64_t num_relinearized = 0;
  std::int64_t num_eliminated = 0;
  // Sum of e^T Omega e over the edges, kernels and priors left out; of kBatch also at the start.
  // Nothing if kIncremental failed on the way.
  std::optional<double> chi2;
  std::optional<double> chi2_initial;
  std::optional<double> cost;  // of the edges under their kernels: what was made small
  // From the first pose's value until the solution can be read; reading the file and scoring are
  // outside.
  double total_s = 0;
  double init_s = 0;  // of kBatch: of total_s, the time until there are initial values
  double cpu_s = 0;
  std::optional<double> peak_rss_mib;
  std::vector<double> updates_s;  // of kIncremental: one update() and reading the newest pose
  std::vector<Update> updates;    // one for each of updates_s
};

// `back_end` is empty before and has the solution afterwards. The graph's fixed poses are held by
// priors; without any, the lowest pose is. Batch: initial values, add(), solve(). Incremental:
// poses in the order of backend::spanning_order(), ascending numbers on a drive, each at its edge
// to the nearest earlier one, with all edges to earlier poses; the newest is read after each
// update.
// An Error: poses that no edges join to a held one, or that edges of singular information leave
// undetermined. A back-end that does not converge is no Error.
Result<SolveRun> solve_graph(const formats::PoseGraph& graph, backend::BackEnd& back_end,
                             const SolveOptions& options);

}  // namespace corridor::solve
