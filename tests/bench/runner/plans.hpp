// Suites of tests and their plans.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bench/runner/plan.hpp"
#include "bench/runner/suite.hpp"

namespace corridor::testing {

inline runner::Suite suite_of(const std::vector<std::string>& systems,
                              const std::vector<std::string>& datasets = {}) {
  runner::Suite suite;
  suite.name = "test";
  for (const std::string& text : systems)
    suite.systems.push_back(*runner::parse_system_choice(text));
  suite.datasets = datasets;
  return suite;
}

// No folder at all: nothing recorded is found.
inline runner::Plan plan_of(const runner::Suite& suite) {
  const Result<runner::Plan> plan = runner::make_plan(suite, catalog::DataDirs{});
  EXPECT_TRUE(plan.has_value()) << plan.error().to_line();
  return *plan;
}

}  // namespace corridor::testing
