// One case from its spec to its folder: data, system, drive, scores, files.
// A system that fails is a result; a CaseFailure is a case that has none.
#pragma once

#include <filesystem>
#include <optional>

#include "bench/results/run_result.hpp"
#include "bench/runner/case_spec.hpp"
#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

// The record's fields that are known before anything runs; status is `failed` until something did.
// `jobs`: how many cases run at a time, if known.
results::RunResult record_of(const CaseSpec& spec, std::optional<int> jobs);

struct CaseFailure {
  Error error;
  // The results cannot be written (a full disk); otherwise request or data cannot be used.
  bool is_of_output = false;
};

// Runs the case in this process and leaves out/runs/<case-id>/. On a failure nothing is left
// behind.
tl::expected<results::RunResult, CaseFailure> run_case(const CaseSpec& spec,
                                                       const catalog::DataDirs& dirs,
                                                       const std::filesystem::path& out,
                                                       std::optional<int> jobs);

}  // namespace corridor::runner
