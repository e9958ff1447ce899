// What a results folder holds from runs before: it stays there, beside the cases of this run.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/results/results_store.hpp"
#include "bench/runner/case_spec.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

struct EarlierCases {
  std::size_t num_cases = 0;  // that this run does not replace
  std::vector<std::string> suites;
};

// An Error if a data set of `cases` is there under the same name with other bytes: tables would put
// the two together.
Result<EarlierCases> earlier_cases(const results::ResultsStore& store,
                                   const std::vector<CaseSpec>& cases,
                                   const std::filesystem::path& folder);

}  // namespace corridor::runner
