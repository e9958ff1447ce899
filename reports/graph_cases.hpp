// What reports know about cases that solve pose graphs: which of them count as solved, and the
// updates that an incremental one left in its folder.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reports/cases.hpp"
#include "slam/core/result.hpp"

namespace corridor::reports {

// Solved is what ends within this of the best chi2 that is known; below it in any case. At once:
// what solvers that agree on an optimum differ by. Pose by pose: nobody goes on until nothing
// moves. To either results::kExactFit_chi2 is added: where the best is zero, no share of it helps.
inline constexpr double kSolvedAtOnce_ratio = 1e-6;
inline constexpr double kSolvedPoseByPose_ratio = 5e-4;

// The value of a parameter; 0 where the record has none of that name.
double number_of(const results::RunResult& result, const std::string& parameter);
// Whether the case's seed draws anything: noise on the start, or false closures. Otherwise every
// repeat is the same run, and only its times differ.
bool is_drawn(const results::RunResult& result);

// Ended with status ok and a chi2 within `ratio` of the best known, in the sense above.
bool is_within(const results::RunResult& result, double ratio);
bool is_pose_by_pose(const results::RunResult& result);
bool is_solved(const results::RunResult& result);

struct Checkpoint {
  double chi2 = 0, chi2_optimum = 0, newest_gap_m = 0;
};

// A line of updates.csv.
struct UpdateRow {
  double num_poses = 0;  // so far
  double time_s = 0;
  std::optional<Checkpoint> checkpoint;
};

// An Error with file:line for what is no line of updates.csv, or if there is none.
Result<std::vector<UpdateRow>> read_updates(const std::filesystem::path& case_dir);

}  // namespace corridor::reports
