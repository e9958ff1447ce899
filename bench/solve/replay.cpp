#include "bench/solve/replay.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include "bench/runner/process_clock.hpp"

namespace corridor::solve {
namespace {

using backend::BackEnd;
using backend::BackEndReport;
using backend::has_failed;
using backend::SolveStatus;
using graph::FactorId;
using graph::NewFactor;
using Clock = std::chrono::steady_clock;

// The estimate of the pose before this one, or the edge to it, leads beyond all numbers.
void lose(std::uint32_t pose, SolveRun& run) {
  run.status = SolveStatus::kNotFinite;
  run.status_message = graph::to_text(graph::pose_key(pose)) + " starts at no finite value";
}

// Where the edge to the earlier pose says that a new pose is. False: nowhere.
bool place(BackEnd& back_end, Step& step, SolveRun& run) {
  if (!step.placement) return true;
  const Pose2 T_map_base =
      back_end.pose(step.placement->parent()) * step.placement->T_parent_pose();
  if (!T_map_base.is_finite()) {
    lose(step.placement->pose, run);
    return false;
  }
  step.values.set_pose(step.placement->pose, T_map_base);
  return true;
}

void converge(BackEnd& back_end, SolveRun& run) {
  const Clock::time_point start = Clock::now();
  const BackEndReport report = back_end.update_until_converged({});
  run.converge_rounds = report.num_iterations;
  count(report, run);
  run.converge_s = runner::seconds_since(start);
}

// One run, from the first step to the last.
class Replay {
 public:
  Replay(BackEnd& back_end, const SolveOptions& options, SolveRun& run)
      : back_end_(back_end), options_(options), run_(run) {}

  Result<void> take(Step step) {
    const std::vector<FactorId> removed = numbers_of(step.removed);
    if (options_.after_update) tell_witness(step);
    const Clock::time_point start = Clock::now();
    if (!place(back_end_, step, run_)) return {};
    const Result<BackEndReport> report = tell(step, removed);
    if (!report) return tl::make_unexpected(report.error());
    std::optional<Pose2> T_map_newest;
    if (step.reading) T_map_newest = back_end_.pose(step.reading->pose);
    open_s_ += runner::seconds_since(start);
    keep(*report, step.call);
    if (!step.reading) return {};
    run_.online.push_back({step.reading->pose, *T_map_newest});
    if (step.reading->ends_update) end_update(*report, *step.reading);
    return {};
  }

 private:
  // As this back-end numbers them: those of the steps are numbered as they came.
  std::vector<FactorId> numbers_of(const std::vector<FactorId>& factors) const {
    std::vector<FactorId> numbers;
    numbers.reserve(factors.size());
    for (const FactorId factor : factors) numbers.push_back(numbers_.at(factor));
    return numbers;
  }

  Result<BackEndReport> tell(Step& step, const std::vector<FactorId>& removed) {
    BackEndReport report;
    switch (step.call) {
      case Call::kAdd:
        report.new_factor_ids = back_end_.add(std::move(step.factors), step.values);
        return report;
      case Call::kUpdate:
        return back_end_.update(std::move(step.factors), step.values, removed);
      case Call::kSolve:
        return back_end_.solve();
      case Call::kConverge:
        return back_end_.update_until_converged(step.budget);
      case Call::kSetValues:
        back_end_.set_values(step.values);
        return report;
      case Call::kMarginalize:
        for (const graph::Key key : step.marginalized) {
          run_.marginalized.copy(key, back_end_.estimate());
        }
        if (auto done = back_end_.marginalize(step.marginalized); !done) {
          return tl::make_unexpected(done.error());
        }
        return report;
    }
    return report;
  }

  // A graph numbers factors as they come.
  void tell_witness(const Step& step) {
    for (const NewFactor& factor : step.factors) told_.add(factor);
    for (const FactorId number : step.removed) told_.remove(number);
  }

  void keep(const BackEndReport& report, Call call) {
    numbers_.insert(numbers_.end(), report.new_factor_ids.begin(), report.new_factor_ids.end());
    if (call != Call::kUpdate && call != Call::kSolve && call != Call::kConverge) return;
    count(report, run_);
    open_.num_relinearized += report.num_relinearized;
    open_.num_eliminated += report.num_eliminated;
  }

  void end_update(const BackEndReport& report, const Step::Reading& reading) {
    Update update = std::exchange(open_, {});
    update.newest = reading.pose;
    update.num_poses = reading.num_poses;
    update.num_factor_nonzeros = report.num_factor_nonzeros;
    run_.updates_s.push_back(std::exchange(open_s_, 0));
    run_.updates.push_back(update);
    if (options_.after_update) {
      options_.after_update({run_.updates.back(), back_end_, told_, run_.marginalized});
    }
  }

  BackEnd& back_end_;
  const SolveOptions& options_;
  SolveRun& run_;
  std::vector<FactorId> numbers_;  // by the factors' order of coming
  // Of the steps since the last update.
  double open_s_ = 0;
  Update open_;
  graph::FactorGraph told_;  // for options_.after_update
};

}  // namespace

std::string message_of(const BackEndReport& report) {
  switch (report.status) {
    case SolveStatus::kRankDeficient:
      return report.undetermined ? graph::to_text(*report.undetermined) + " is undetermined"
                                 : "some pose is undetermined";
    case SolveStatus::kNotFinite:
      return "a residual or its derivative is not finite";
    case SolveStatus::kMaxIterations:
      return "the limit of iterations came before convergence";
    case SolveStatus::kConverged:
    case SolveStatus::kEmpty:
      return "";
  }
  return "";
}

graph::Values Moment::estimate() const {
  graph::Values values = marginalized;
  values.merge(back_end.estimate());
  return values;
}

void count(const BackEndReport& report, SolveRun& run) {
  run.status = report.status;
  run.status_message = message_of(report);
  run.num_iterations += report.num_iterations;
  run.num_relinearized += report.num_relinearized;
  run.num_eliminated += report.num_eliminated;
  run.num_factor_nonzeros = report.num_factor_nonzeros;
  run.num_dropped += report.num_dropped_factors;
}

Result<void> replay(const Steps& steps, BackEnd& back_end, const SolveOptions& options,
                    SolveRun& run) {
  Replay replay(back_end, options, run);
  for (std::size_t k = 0; k < steps.size && !has_failed(run.status); ++k) {
    if (auto done = replay.take(steps.at(k)); !done) return done;
  }
  if (options.do_converge && !has_failed(run.status)) converge(back_end, run);
  return {};
}

}  // namespace corridor::solve
