#include "slam/backend/fixed_lag/fixed_lag.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "slam/core/expect.hpp"

namespace corridor::backend {
namespace {

using graph::FactorId;
using graph::Key;
using graph::NewFactor;
using graph::Values;

class FixedLag final : public BackEnd {
 public:
  explicit FixedLag(const FixedLagParams& params)
      : lag_(params.lag), window_(make_isam2(params.isam2)) {}

  std::string_view name() const override { return "fixed-lag"; }

  std::vector<FactorId> add(std::vector<NewFactor> new_factors, const Values& new_values) override {
    Arrival arrival = arrive(std::move(new_factors), new_values);
    return spread(window_->add(std::move(arrival.factors), arrival.values), arrival);
  }

  BackEndReport update(std::vector<NewFactor> new_factors, const Values& new_values,
                       std::span<const FactorId> removed_factors) override {
    std::vector<FactorId> removable;
    for (const FactorId id : removed_factors) {
      if (window_->graph().contains(id)) {
        removable.push_back(id);
      } else if (id != kNoFactor) {
        ++num_late_removals_;
      }
    }
    Arrival arrival = arrive(std::move(new_factors), new_values);
    BackEndReport report = window_->update(std::move(arrival.factors), arrival.values, removable);
    report.new_factor_ids = spread(std::move(report.new_factor_ids), arrival);
    return slide(std::move(report));
  }

  BackEndReport solve() override { return slide(window_->solve()); }
  BackEndReport update_until_converged(const ConvergenceBudget& budget) override {
    return slide(window_->update_until_converged(budget));
  }

  Result<void> marginalize(std::span<const Key> keys) override {
    Values last;
    for (const Key key : keys) {
      if (newest_use_.contains(key)) last.copy(key, window_->estimate());
    }
    if (auto done = window_->marginalize(keys); !done) return done;
    values_.merge(last);
    for (const Key key : keys) newest_use_.erase(key);
    is_current_ = false;
    return {};
  }

  void set_values(const Values& values) override {
    Values in_window;
    for (const Key key : values.keys()) {
      CORRIDOR_EXPECT(values_.contains(key));
      (newest_use_.contains(key) ? in_window : values_).copy(key, values);
    }
    window_->set_values(in_window);
    is_current_ = false;
  }

  const Values& estimate() const override {
    if (!is_current_) values_.merge(window_->estimate());
    is_current_ = true;
    return values_;
  }
  Pose2 pose(std::uint32_t index) override {
    return newest_use_.contains(graph::pose_key(index)) ? window_->pose(index)
                                                        : values_.pose(index);
  }
  const graph::FactorGraph& graph() const override { return window_->graph(); }

  Result<Eigen::MatrixXd> marginal_covariance(Key key) override {
    if (!newest_use_.contains(key) && values_.contains(key)) {
      return fail(ErrorCode::kNotFound, graph::to_text(key) + " left the window",
                  "marginal covariance");
    }
    return window_->marginal_covariance(key);
  }

 private:
  // What of new factors and values concerns the window.
  struct Arrival {
    std::vector<NewFactor> factors;
    Values values;
    std::vector<bool> is_kept;  // by factor, as they came
  };

  Arrival arrive(std::vector<NewFactor> new_factors, const Values& new_values) {
    Arrival arrival;
    for (const Key key : new_values.keys()) {
      const bool is_known = newest_use_.contains(key);
      if (!is_known && values_.contains(key)) {
        values_.copy(key, new_values);  // it left: its value is all that there is
        continue;
      }
      if (!is_known && key.kind == graph::VariableKind::kPose) ++num_poses_;
      arrival.values.copy(key, new_values);
      // Known to values_ from now on, so that it is known as one that left when it has.
      values_.copy(key, new_values);
      newest_use_.emplace(key, num_poses_);
    }
    for (NewFactor& factor : new_factors) {
      const auto keys = keys_of(factor.factor);
      const bool is_kept = std::all_of(keys.begin(), keys.end(), [&](Key key) {
        CORRIDOR_EXPECT(values_.contains(key));
        return newest_use_.contains(key);
      });
      arrival.is_kept.push_back(is_kept);
      num_dropped_ += is_kept ? 0 : 1;
      if (!is_kept) continue;
      for (const Key key : keys) use(key);
      arrival.factors.push_back(std::move(factor));
    }
    is_current_ = false;
    return arrival;
  }

  // A closure to an old pose does not keep it: the window would have no bound.
  void use(Key key) {
    if (key.kind != graph::VariableKind::kPose) newest_use_[key] = num_poses_;
  }

  // The numbers of all factors that came, from those of the kept ones.
  static std::vector<FactorId> spread(std::vector<FactorId> ids, const Arrival& arrival) {
    std::vector<FactorId> all;
    auto next = ids.begin();
    for (const bool is_kept : arrival.is_kept) all.push_back(is_kept ? *next++ : kNoFactor);
    return all;
  }

  // Takes out what is older than the lag. Nothing leaves by a solution that failed.
  BackEndReport slide(BackEndReport report) {
    report.num_dropped_factors = std::exchange(num_dropped_, 0);
    report.num_late_removals = std::exchange(num_late_removals_, 0);
    is_current_ = false;
    if (report.status != SolveStatus::kConverged && report.status != SolveStatus::kMaxIterations) {
      return report;
    }
    std::vector<Key> leaving;
    for (const auto& [key, newest_use] : newest_use_) {
      if (num_poses_ - newest_use >= lag_) leaving.push_back(key);
    }
    if (leaving.empty()) return report;
    if (!marginalize(leaving)) {
      report.status = SolveStatus::kRankDeficient;
      report.undetermined = leaving.front();
    }
    return report;
  }

  std::int64_t lag_;
  std::unique_ptr<BackEnd> window_;
  mutable Values values_;  // of the window as of when is_current_ was set
  mutable bool is_current_ = true;
  // The variables of the window, with the number of poses that had come when each was new, or, but
  // for poses, was named by a factor last.
  std::map<Key, std::int64_t> newest_use_;
  std::int64_t num_poses_ = 0;
  // Since the report before.
  std::int64_t num_dropped_ = 0, num_late_removals_ = 0;
};

}  // namespace

std::unique_ptr<BackEnd> make_fixed_lag(const FixedLagParams& params) {
  return std::make_unique<FixedLag>(params);
}

}  // namespace corridor::backend
