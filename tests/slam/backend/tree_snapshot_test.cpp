// What a snapshot of the Bayes tree says, while a graph grows and closes loops.
#include "slam/backend/isam2/tree_snapshot.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "slam/backend/fixed_lag/fixed_lag.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"
#include "tests/slam/backend/ring_problem.hpp"

namespace corridor::backend {
namespace {

using graph::Key;
using testing::ring;
using Clique = TreeSnapshot::Clique;

std::multiset<Key> frontals_of(const TreeSnapshot& tree) {
  std::multiset<Key> keys;
  for (const Clique& clique : tree.cliques) {
    keys.insert(clique.frontals.begin(), clique.frontals.end());
  }
  return keys;
}

const Clique* same_clique(const Clique& clique, const TreeSnapshot& tree) {
  const auto found = std::find_if(tree.cliques.begin(), tree.cliques.end(),
                                  [&](const Clique& c) { return c.birth == clique.birth; });
  return found == tree.cliques.end() ? nullptr : &*found;
}

using Look = std::function<void(const TreeSnapshot& before, const TreeSnapshot& after,
                                const BackEndReport& report)>;

// Two rounds of a ring, pose by pose. Few of the newest variables are kept last: the tree is deep.
void walk(std::uint64_t seed, const Look& look) {
  const testing::PoseGraph problem = ring(seed);
  Isam2Params params;
  params.num_last = 2;
  const auto solver = make_isam2(params);
  TreeSnapshot before = *tree_of(*solver);
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    graph::Values values;
    values.set_pose(i, problem.initial.pose(i));
    const BackEndReport report = solver->update(problem.steps[i], values, {});
    const TreeSnapshot after = *tree_of(*solver);
    look(before, after, report);
    before = after;
  }
}

RC_GTEST_PROP(TreeSnapshot, HasEveryVariableAsFrontalOfExactlyOneClique, (std::uint64_t seed)) {
  walk(seed, [](const TreeSnapshot&, const TreeSnapshot& after, const BackEndReport& report) {
    const std::multiset<Key> frontals = frontals_of(after);
    RC_ASSERT(static_cast<std::int64_t>(frontals.size()) == report.num_variables);
    RC_ASSERT(std::set<Key>(frontals.begin(), frontals.end()).size() == frontals.size());
    RC_ASSERT(static_cast<std::int64_t>(after.cliques.size()) == report.num_cliques);
  });
}

RC_GTEST_PROP(TreeSnapshot, HasParentsFirstThatHoldTheSeparatorsOfTheirChildren,
              (std::uint64_t seed)) {
  walk(seed, [](const TreeSnapshot&, const TreeSnapshot& after, const BackEndReport&) {
    for (int place = 0; place < static_cast<int>(after.cliques.size()); ++place) {
      const Clique& clique = after.cliques[static_cast<std::size_t>(place)];
      RC_ASSERT(clique.parent < place);
      RC_ASSERT(clique.separator.empty() == (clique.parent == TreeSnapshot::kNoParent));
      if (clique.parent == TreeSnapshot::kNoParent) continue;
      const Clique& parent = after.cliques[static_cast<std::size_t>(clique.parent)];
      std::set<Key> held(parent.frontals.begin(), parent.frontals.end());
      held.insert(parent.separator.begin(), parent.separator.end());
      for (const Key key : clique.separator) RC_ASSERT(held.contains(key));
    }
  });
}

RC_GTEST_PROP(TreeSnapshot, HasTheSameVariablesWhereACliqueStayed, (std::uint64_t seed)) {
  walk(seed, [](const TreeSnapshot& before, const TreeSnapshot& after, const BackEndReport&) {
    for (const Clique& clique : after.cliques) {
      const Clique* const old = same_clique(clique, before);
      RC_ASSERT((old == nullptr) == (fate_of(clique, before) == CliqueFate::kReplaced));
      if (old == nullptr) continue;
      RC_ASSERT(old->frontals == clique.frontals);
      RC_ASSERT(old->separator == clique.separator);
    }
  });
}

// Of updates of one round: what is eliminated anew is what the report counts.
RC_GTEST_PROP(TreeSnapshot, CallsUntouchedWhatTheUpdateDidNotEliminate, (std::uint64_t seed)) {
  bool has_untouched = false;
  walk(seed,
       [&](const TreeSnapshot& before, const TreeSnapshot& after, const BackEndReport& report) {
         if (report.num_iterations != 1) return;
         std::size_t num_eliminated = 0;
         for (const Clique& clique : after.cliques) {
           const bool is_untouched = fate_of(clique, before) == CliqueFate::kUntouched;
           has_untouched = has_untouched || is_untouched;
           if (!is_untouched) num_eliminated += clique.frontals.size();
         }
         RC_ASSERT(static_cast<std::int64_t>(num_eliminated) == report.num_eliminated);
       });
  RC_ASSERT(has_untouched);
}

TEST(TreeSnapshot, TellsCliquesThatWereEliminatedAgainFromUntouchedOnes) {
  const testing::PoseGraph problem = ring(1);
  const auto solver = make_isam2({});
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    graph::Values values;
    values.set_pose(i, problem.initial.pose(i));
    solver->update(problem.steps[i], values, {});
  }
  const TreeSnapshot before = *tree_of(*solver);
  // Relinearises every variable, where it is.
  solver->update_until_converged({});
  const TreeSnapshot after = *tree_of(*solver);
  for (const Clique& clique : after.cliques) {
    EXPECT_EQ(fate_of(clique, before), CliqueFate::kEliminatedAgain);
  }
}

TEST(TreeSnapshot, IsOfIsam2Alone) {
  EXPECT_TRUE(tree_of(*make_isam2({})));
  EXPECT_FALSE(tree_of(*make_least_squares({})));
  EXPECT_FALSE(tree_of(*make_fixed_lag({})));
}

}  // namespace
}  // namespace corridor::backend
