// One case from its spec to its folder: data, system, drive, scores, files.
// A system that fails is a result; an Error is a request or data that cannot be used.
#pragma once

#include <filesystem>

#include "bench/results/run_result.hpp"
#include "bench/runner/case_spec.hpp"
#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

// The record's fields that are known before anything runs; status is `failed` until something did.
results::RunResult record_of(const CaseSpec& spec);

// Runs the case in this process and leaves out/runs/<case-id>/. On an Error nothing is left behind.
Result<results::RunResult> run_case(const CaseSpec& spec, const catalog::DataDirs& dirs,
                                    const std::filesystem::path& out);

}  // namespace corridor::runner
