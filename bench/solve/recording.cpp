#include "bench/solve/recording.hpp"

#include <optional>
#include <unordered_map>
#include <utility>

#include "slam/core/expect.hpp"

namespace corridor::solve {
namespace {

using backend::BackEnd;
using backend::BackEndReport;
using graph::FactorId;
using graph::NewFactor;
using graph::Values;

class RecordingBackEnd final : public BackEnd {
 public:
  RecordingBackEnd(std::unique_ptr<BackEnd> back_end, Recording& recording)
      : back_end_(std::move(back_end)), recording_(recording) {
    CORRIDOR_EXPECT(back_end_ != nullptr);
  }

  [[nodiscard]] std::string_view name() const override { return back_end_->name(); }

  BackEndReport update(std::vector<NewFactor> new_factors, const Values& new_values,
                       std::span<const FactorId> removed_factors) override {
    Step& step = arrive(Call::kUpdate, new_factors, new_values);
    for (const FactorId id : removed_factors) {
      if (const auto found = orders_.find(id); found != orders_.end()) {
        step.removed.push_back(found->second);
      }
    }
    end_update();
    BackEndReport report = back_end_->update(std::move(new_factors), new_values, removed_factors);
    number(report.new_factor_ids);
    return report;
  }

  std::vector<FactorId> add(std::vector<NewFactor> new_factors, const Values& new_values) override {
    arrive(Call::kAdd, new_factors, new_values);
    std::vector<FactorId> ids = back_end_->add(std::move(new_factors), new_values);
    number(ids);
    return ids;
  }

  BackEndReport solve() override {
    recording_.steps.emplace_back().call = Call::kSolve;
    end_update();
    return back_end_->solve();
  }

  BackEndReport update_until_converged(const backend::ConvergenceBudget& budget) override {
    Step& step = recording_.steps.emplace_back();
    step.call = Call::kConverge;
    step.budget = budget;
    end_update();
    return back_end_->update_until_converged(budget);
  }

  Result<void> marginalize(std::span<const graph::Key> keys) override {
    auto done = back_end_->marginalize(keys);
    if (!done) return done;  // and nothing has changed
    Step& step = recording_.steps.emplace_back();
    step.call = Call::kMarginalize;
    step.marginalized.assign(keys.begin(), keys.end());
    return done;
  }

  void set_values(const Values& values) override {
    Step& step = recording_.steps.emplace_back();
    step.call = Call::kSetValues;
    step.values = values;
    back_end_->set_values(values);
  }

  [[nodiscard]] const Values& estimate() const override { return back_end_->estimate(); }
  [[nodiscard]] Pose2 pose(std::uint32_t index) override { return back_end_->pose(index); }
  [[nodiscard]] const graph::FactorGraph& graph() const override { return back_end_->graph(); }
  Result<Eigen::MatrixXd> marginal_covariance(graph::Key key) override {
    return back_end_->marginal_covariance(key);
  }

 private:
  Step& arrive(Call call, const std::vector<NewFactor>& factors, const Values& values) {
    for (const graph::Key key : values.keys()) {
      if (key.kind != graph::VariableKind::kPose || poses_.contains(key)) continue;
      poses_.copy(key, values);
      newest_pose_ = key.index;
    }
    Step& step = recording_.steps.emplace_back();
    step.call = call;
    step.factors = factors;
    step.values = values;
    return step;
  }

  void end_update() {
    if (newest_pose_) recording_.steps.back().reading = {*newest_pose_, poses_.size(), true};
  }

  void number(const std::vector<FactorId>& ids) {
    for (const FactorId id : ids) {
      if (id != backend::kNoFactor) orders_[id] = num_factors_;
      ++num_factors_;
    }
  }

  std::unique_ptr<BackEnd> back_end_;
  Recording& recording_;
  Values poses_;  // that came so far
  std::optional<std::uint32_t> newest_pose_;
  std::unordered_map<FactorId, FactorId> orders_;  // of coming, by the back-end's number
  FactorId num_factors_ = 0;
};

}  // namespace

graph::FactorGraph Recording::factors() const {
  std::vector<const NewFactor*> kept;
  for (const Step& step : steps) {
    for (const FactorId order : step.removed) kept.at(order) = nullptr;
    for (const NewFactor& factor : step.factors) kept.push_back(&factor);
  }
  graph::FactorGraph factors;
  for (const NewFactor* factor : kept) {
    if (factor != nullptr) factors.add(*factor);
  }
  return factors;
}

Values Recording::initial_values() const {
  Values values;
  for (const Step& step : steps) {
    if (step.call == Call::kSetValues) continue;
    for (const graph::Key key : step.values.keys()) {
      if (!values.contains(key)) values.copy(key, step.values);
    }
  }
  return values;
}

Steps steps_of(const Recording& recording) {
  return {recording.steps.size(), [&recording](std::size_t k) { return recording.steps[k]; }};
}

std::size_t drop_unsolved_end(Recording& recording) {
  std::size_t num_dropped = 0;
  std::vector<Step>& steps = recording.steps;
  while (!steps.empty() && !steps.back().reading) {
    num_dropped += steps.back().factors.size();
    steps.pop_back();
  }
  const Values kept = recording.initial_values();
  for (const graph::Key key : recording.final_estimate.keys()) {
    if (!kept.contains(key)) recording.final_estimate.erase(key);
  }
  return num_dropped;
}

std::unique_ptr<BackEnd> make_recording(std::unique_ptr<BackEnd> back_end, Recording& recording) {
  return std::make_unique<RecordingBackEnd>(std::move(back_end), recording);
}

std::map<std::string, std::size_t> kinds_of(const graph::FactorGraph& factors) {
  std::map<std::string, std::size_t> kinds;
  factors.for_each([&]<class F>(FactorId, const F&, const graph::RobustKernel&) {
    ++kinds[std::string(F::kName)];
  });
  return kinds;
}

}  // namespace corridor::solve
