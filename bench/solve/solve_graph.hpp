// Solves a pose graph of a file, or the graph that a system made, with any back-end, all at once or
// step by step, and measures what that took. It reads and writes no files and knows no back-end by
// name.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/solve/recording.hpp"
#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/backend/back_end.hpp"
#include "slam/backend/robust/graduated_non_convexity.hpp"
#include "slam/core/result.hpp"
#include "slam/graph/robust_kernel.hpp"

namespace corridor::solve {

// Limits of a batch solution: Levenberg-Marquardt takes many more iterations than plain
// Gauss-Newton; solutions are compared to six digits, so they stop well below.
inline constexpr int kMaxBatchIterations = 100;
inline constexpr double kMinBatchRelativeDecrease = 1e-9;

enum class Mode { kBatch, kIncremental };
enum class Initialization { kFile, kOdometry, kChordal };
inline constexpr std::array kInitializations = {Initialization::kFile, Initialization::kOdometry,
                                                Initialization::kChordal};
// "file", "odometry", "chordal".
std::string_view to_text(Initialization init);

// Finds false loop closures; of kBatch alone, since it looks at all edges at once.
enum class Rejection {
  kNone,
  kGnc,              // graduated non-convexity with the truncated loss [Yang2020]
  kGncGemanMcClure,  // the same with Geman and McClure's
  kPcm,              // pairwise consistency maximisation [Mangelson2018]
};
inline constexpr std::array kRejections = {Rejection::kNone, Rejection::kGnc,
                                           Rejection::kGncGemanMcClure, Rejection::kPcm};
// "none", "gnc", "gnc-geman-mcclure", "pcm".
std::string_view to_text(Rejection rejection);

// What one update did in kIncremental: the poses up to one at which the back-end is asked to solve,
// or the calls of a system up to one that solves.
struct Update {
  std::uint32_t newest = 0;   // the pose
  std::size_t num_poses = 0;  // so far
  std::int64_t num_relinearized = 0;
  std::int64_t num_eliminated = 0;
  std::int64_t num_factor_nonzeros = 0;  // 0: unknown
};

// Right after an update.
struct Moment {
  const Update& update;
  const backend::BackEnd& back_end;
  // All factors that came and were not removed, whatever of them the back-end has forgotten.
  const graph::FactorGraph& told;
  const graph::Values& marginalized;  // as they were then

  // Of all variables that came.
  [[nodiscard]] graph::Values estimate() const;
};

struct SolveOptions {
  Mode mode = Mode::kBatch;
  Initialization init = Initialization::kFile;  // of kBatch
  int poses_per_update = 1;                     // of kIncremental: the last one always updates
  bool do_converge = false;                     // of kIncremental: after the last pose
  // Of the loop closures alone: odometry is trusted, as rejections do. Not together with one.
  graph::RobustKernel kernel = {};
  Rejection rejection = Rejection::kNone;
  // Of a true closure to be below the bound of kGnc, and to count as such under a kernel; of two
  // true closures to agree for kPcm.
  double inlier_probability = backend::GncParams().inlier_probability;
  backend::MakeBackEnd make_back_end = {};  // for the weighted solutions of kGnc
  // The last so many edges are false closures that were planted: the chi2 of a run leaves them out.
  std::size_t num_planted = 0;
  // Of kIncremental: called after every update, with its clock stopped. For replays: total_s, cpu_s
  // and the memory have in them what it does, and the factors that are kept for it.
  std::function<void(const Moment&)> after_update = {};
};

struct SolveRun {
  // Of kIncremental: of the last update. The words are those of backend::to_text().
  backend::SolveStatus status = backend::SolveStatus::kEmpty;
  std::string status_message;      // what the status does not say; empty for nothing
  std::vector<std::string> notes;  // what a reader should know of a solution that has come
  // Sums over all updates.
  std::int64_t num_iterations = 0;
  std::int64_t num_relinearized = 0;
  std::int64_t num_eliminated = 0;
  std::int64_t num_factor_nonzeros = 0;  // of the last solution; 0: unknown
  // Edges to poses that a back-end has forgotten; in chi2 all the same.
  std::int64_t num_dropped = 0;
  // By the graph's Measure (optimum.hpp); that of the edges has rejected ones in it. Of kBatch also
  // at the start. Nothing if kIncremental failed on the way.
  std::optional<double> chi2;
  std::optional<double> chi2_initial;
  // Of the edges under their kernels or weights: what was made small; rejected ones are not in it.
  std::optional<double> cost;
  // Loop closures by their number among the edges, ascending: what a rejection found; under a
  // kernel those whose chi2 is beyond the bound at the solution. Nothing without either.
  std::optional<std::vector<graph::FactorId>> rejected;
  // From the first pose's value until the solution can be read; reading the file and scoring are
  // outside.
  double total_s = 0;
  double init_s = 0;  // of kBatch: of total_s, the time until there are initial values
  // With do_converge: what update_until_converged() took, of total_s and num_iterations.
  std::optional<double> converge_s;
  std::optional<int> converge_rounds;
  double cpu_s = 0;
  std::optional<double> peak_rss_mib;
  std::optional<double> peak_growth_mib;  // of that, beyond what the process had before
  // Of kIncremental, all three: what every update took, with reading the newest pose of each of its
  // steps, what it did, and where every pose was read when it was the newest.
  std::vector<double> updates_s;
  std::vector<Update> updates;
  std::vector<formats::PoseGraph::Vertex> online;
  graph::Values marginalized;  // variables that a recording takes out, as they were then
};

// `back_end` is empty before and has the solution afterwards. The graph's fixed poses are held by
// priors; without any, the lowest pose is. Batch: initial values, add(), solve(). Incremental:
// poses in the order of backend::spanning_order(), ascending numbers on a drive, each at its edge
// to the nearest earlier one, with all edges to earlier poses, and read at once. With several poses
// per update the ones between are added at their edges and wait: "batch every k steps".
// An Error: poses that no edges join to a held one, or that edges of singular information leave
// undetermined. A back-end that does not converge is no Error.
Result<SolveRun> solve_graph(const formats::PoseGraph& graph, backend::BackEnd& back_end,
                             const SolveOptions& options);

// Batch: what there is at the end, from the values that the system gave. Incremental: the system's
// calls as they came. Requires that `options` are as they are by default but for mode, do_converge
// and after_update: the rest is of pose graphs. An Error: a recording that marginalises, to a
// back-end that does not.
Result<SolveRun> solve_graph(const Recording& recording, backend::BackEnd& back_end,
                             const SolveOptions& options);

}  // namespace corridor::solve
