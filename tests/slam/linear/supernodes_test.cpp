#include "slam/linear/supernodes.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "slam/linear/elimination_tree.hpp"
#include "slam/linear/minimum_degree.hpp"
#include "tests/slam/linear/random_blocks.hpp"

namespace corridor::linear {
namespace {

struct Case {
  BlockPattern pattern;
  std::vector<int> dimensions;
  std::vector<int> order;
};

Case random_case(std::uint64_t seed) {
  Rng rng(seed);
  const int num_variables = 1 + below(rng, 25);
  Case made;
  made.dimensions = random_dimensions(rng, num_variables);
  made.pattern = make_structure(rng, made.dimensions, random_pairs(rng, num_variables)).pattern();
  made.order = minimum_degree_order(made.pattern);
  // Laws of plans hold for any order.
  if (rng.uniform() < 0.5) {
    for (std::size_t k = made.order.size(); k > 1; --k) {
      std::swap(made.order[k - 1],
                made.order[static_cast<std::size_t>(below(rng, static_cast<int>(k)))]);
    }
  }
  return made;
}

// Rows of every column of L below its diagonal, by elimination on a graph of sets.
std::vector<std::set<int>> eliminate(const BlockPattern& pattern, const std::vector<int>& place) {
  std::vector<std::set<int>> rows(place.size());
  for (int j = 0; j < pattern.num_variables(); ++j) {
    for (const int i : pattern.of(j)) {
      const auto [low, high] = std::minmax(place[to_index(i)], place[to_index(j)]);
      rows[to_index(low)].insert(high);
    }
  }
  for (std::set<int>& column : rows) {
    for (const int i : column) {
      for (const int k : column) {
        if (k > i) rows[to_index(i)].insert(k);
      }
    }
  }
  return rows;
}

bool is_permutation(std::vector<int> numbers) {
  std::sort(numbers.begin(), numbers.end());
  std::vector<int> expected(numbers.size());
  std::iota(expected.begin(), expected.end(), 0);
  return numbers == expected;
}

RC_GTEST_PROP(MinimumDegree, OrdersEveryVariableOnce, (std::uint64_t seed)) {
  RC_ASSERT(is_permutation(minimum_degree_order(random_case(seed).pattern)));
}

TEST(MinimumDegree, AStarIsEliminatedFromItsTips) {
  BlockPattern star;
  star.rows = {1, 2, 3, 4, 5};
  star.starts = {0, 5, 5, 5, 5, 5, 5};
  const std::vector<int> order = minimum_degree_order(star);
  EXPECT_GE(std::find(order.begin(), order.end(), 0) - order.begin(), 4);
}

RC_GTEST_PROP(EliminationTree, ParentsAreTheFirstRowsOfTheColumnsOfL, (std::uint64_t seed)) {
  const Case given = random_case(seed);
  std::vector<int> place(given.order.size());
  for (std::size_t k = 0; k < place.size(); ++k) {
    place[to_index(given.order[k])] = static_cast<int>(k);
  }
  const std::vector<std::set<int>> rows = eliminate(given.pattern, place);
  EliminationTree tree;
  tree.build(given.pattern, place);
  const std::vector<int>& parents = tree.parents();
  for (std::size_t j = 0; j < rows.size(); ++j) {
    RC_ASSERT(parents[j] == (rows[j].empty() ? kNoNode : *rows[j].begin()));
  }
  const std::vector<int>& postorder = tree.postorder();
  RC_ASSERT(is_permutation(postorder));
  std::vector<bool> is_done(place.size(), false);
  for (const int node : postorder) {
    is_done[to_index(node)] = true;
    const int parent = parents[to_index(node)];
    if (parent != kNoNode) RC_ASSERT_FALSE(is_done[to_index(parent)]);
  }
}

EliminationPlan plan_of(const BlockPattern& pattern, const std::vector<int>& order,
                        const std::vector<int>& dimensions) {
  return EliminationPlanner().plan(pattern, order, dimensions);
}

RC_GTEST_PROP(EliminationPlan, IsAPermutationInSupernodesWithChildrenFirst, (std::uint64_t seed)) {
  const Case given = random_case(seed);
  const EliminationPlan plan = plan_of(given.pattern, given.order, given.dimensions);
  RC_ASSERT(is_permutation(plan.order));
  for (std::size_t k = 0; k < plan.order.size(); ++k) {
    RC_ASSERT(plan.place[to_index(plan.order[k])] == static_cast<int>(k));
  }
  int next_place = 0;
  for (std::size_t s = 0; s < plan.supernodes.size(); ++s) {
    const Supernode& node = plan.supernodes[s];
    RC_ASSERT(node.first_place == next_place);
    RC_ASSERT(node.end_place > node.first_place);
    next_place = node.end_place;
    RC_ASSERT((node.parent < 0) == plan.rows_of(node).empty());
    RC_ASSERT(node.parent < 0 || node.parent > static_cast<int>(s));
  }
  RC_ASSERT(next_place == static_cast<int>(plan.order.size()));
}

// Joining columns of different rows may add rows to a column, but none to its supernode's last one.
RC_GTEST_PROP(EliminationPlan, SupernodesHaveTheRowsOfTheDenseElimination, (std::uint64_t seed)) {
  const Case given = random_case(seed);
  const EliminationPlan plan = plan_of(given.pattern, given.order, given.dimensions);
  const std::vector<std::set<int>> rows = eliminate(given.pattern, plan.place);
  for (const Supernode& node : plan.supernodes) {
    const std::set<int>& of_last = rows[to_index(node.end_place - 1)];
    const std::span<const int> rows_of_node = plan.rows_of(node);
    RC_ASSERT(std::ranges::equal(of_last, rows_of_node));
    for (int place = node.first_place; place < node.end_place; ++place) {
      for (const int row : rows[to_index(place)]) {
        RC_ASSERT(row < node.end_place || std::ranges::binary_search(rows_of_node, row));
      }
    }
  }
}

// What a front hands on must find its rows in the parent's front.
RC_GTEST_PROP(EliminationPlan, RowsAreTheParentsPivotsAndRows, (std::uint64_t seed)) {
  const Case given = random_case(seed);
  const EliminationPlan plan = plan_of(given.pattern, given.order, given.dimensions);
  for (const Supernode& node : plan.supernodes) {
    if (node.parent < 0) continue;
    const Supernode& parent = plan.supernodes[to_index(node.parent)];
    const std::span<const int> rows = plan.rows_of(node);
    RC_ASSERT(parent.first_place <= rows.front());
    RC_ASSERT(rows.front() < parent.end_place);
    for (const int row : rows) {
      RC_ASSERT(row < parent.end_place || std::ranges::binary_search(plan.rows_of(parent), row));
    }
  }
}

RC_GTEST_PROP(EliminationPlan, IsTheSameInUsedMemory, (std::uint64_t seed)) {
  EliminationPlanner planner;
  for (const std::uint64_t other : {seed + 1, seed + 2, seed}) {
    const Case given = random_case(other);
    const EliminationPlan& plan = planner.plan(given.pattern, given.order, given.dimensions);
    const EliminationPlan fresh = plan_of(given.pattern, given.order, given.dimensions);
    RC_ASSERT(plan.order == fresh.order && plan.place == fresh.place && plan.rows == fresh.rows);
    RC_ASSERT(plan.supernodes.size() == fresh.supernodes.size());
  }
}

TEST(EliminationPlan, VariablesThatAllShareBlocksAreOneSupernode) {
  BlockPattern full;
  full.rows = {1, 2, 3, 2, 3, 3};
  full.starts = {0, 3, 5, 6, 6};
  const std::vector<int> dimensions(4, 30);
  EXPECT_EQ(plan_of(full, {2, 0, 3, 1}, dimensions).supernodes.size(), 1u);
}

}  // namespace
}  // namespace corridor::linear
