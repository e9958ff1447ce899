// What a case leaves behind, runs/<case-id>/: written under another name and renamed when complete,
// so that a folder with its final name is a finished case.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "bench/results/run_result.hpp"
#include "bench/runner/case_data.hpp"
#include "bench/runner/case_spec.hpp"
#include "bench/runner/drive.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

std::filesystem::path case_folder(const std::filesystem::path& out, const std::string& case_id);

// Where a case is written until it is complete.
std::filesystem::path partial_folder(const std::filesystem::path& folder);

// Calls `write` with the empty partial_folder(), then renames that; replaces an older
// `folder`. On an Error nothing is left behind and an older one stays.
Result<void> write_folder_atomically(
    const std::filesystem::path& folder,
    const std::function<Result<void>(const std::filesystem::path& temporary)>& write);

// result.json, spec.json and log.txt: what every case has, however it ended.
Result<void> write_record(const std::filesystem::path& folder, const CaseSpec& spec,
                          const results::RunResult& result, const std::string& log_text);

// online.tum final.tum truth.tum world.toml map.* rendered.* graph.g2o health.csv, each if there is
// one.
struct CaseOutput {
  const CaseData* data = nullptr;
  const Drive* run = nullptr;
  const SlamSystem* system = nullptr;
  const GridMap* rendered_map = nullptr;
};
Result<void> write_output(const std::filesystem::path& folder, const CaseOutput& output);

}  // namespace corridor::runner
