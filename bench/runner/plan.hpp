// From a suite to its cases: systems x back-ends x data x seeds, interleaved so that rivals run on
// the same data one after the other, and what is left out with the reason.
#pragma once

#include <string>
#include <vector>

#include "bench/runner/case_spec.hpp"
#include "bench/runner/suite.hpp"
#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

struct Plan {
  std::vector<CaseSpec> cases;
  std::vector<std::string> skipped;  // one line each: "fr079: not found in ..., skipped"
};

struct PlanOptions {
  // Data that cannot be loaded refuse the whole plan. For data that the user named one by one; a
  // suite skips what this machine does not have and makes a row of what is broken.
  bool must_load_data = false;
};

Result<Plan> make_plan(const Suite& suite, const catalog::DataDirs& dirs,
                       const PlanOptions& options = {});

}  // namespace corridor::runner
