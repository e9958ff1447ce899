// One case of the benchmark: which system on which data with which seeds and limits, as plain data.
// It is what `run` hands to `run-case`, and what --resume compares.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "slam/core/params.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

enum class DataKind {
  kSimulated,  // a scenario and a seed
  kRecorded,   // a log, by catalogue name or path
  kGraph,      // a pose graph, by catalogue name, name of a walk, or path
};
// "simulated", "recorded", "graph".
std::string_view to_text(DataKind kind);

struct CaseLimits {
  double time_s = 600;             // wall time of the whole case, reading and scoring included
  std::int64_t memory_mib = 4096;  // resident memory

  bool operator==(const CaseLimits&) const = default;
};

struct CaseSpec {
  std::string suite;
  std::string system;
  std::string profile;
  std::optional<std::string> backend;
  ParamValues overrides;  // see split_overrides()
  DataKind data_kind = DataKind::kSimulated;
  std::string dataset;      // name for people: the scenario's, the catalogue's, or the file's
  std::string data_source;  // what to load: catalogue name, scenario name, or path
  std::optional<std::uint64_t> data_seed;  // simulated data only
  std::uint64_t system_seed = 1;
  int threads = 1;
  CaseLimits limits;
  std::string data_digest;  // of the scenario, or the log and its truth, when planned

  bool operator==(const CaseSpec&) const = default;
};

// "paper-corridor-s3.karto@as-shipped.levenberg-1f0a3c5b7d9e": readable, and a hash of everything
// that decides the estimate. Limits and the data's digest are left out: the same experiment keeps
// its name.
std::string case_id(const CaseSpec& spec);

std::string to_json(const CaseSpec& spec);
// Unknown keys and wrong types are errors that name `where` and the key.
Result<CaseSpec> case_spec_from_json(std::string_view text, std::string_view where);
Result<CaseSpec> read_case_spec(const std::filesystem::path& path);

}  // namespace corridor::runner
