#include "bench/runner/case_spec.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/results/digest.hpp"

namespace corridor::runner {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kDataKinds = {DataKind::kSimulated, DataKind::kRecorded, DataKind::kGraph};

std::optional<DataKind> data_kind_from(std::string_view text) {
  for (const DataKind kind : kDataKinds) {
    if (to_text(kind) == text) return kind;
  }
  return std::nullopt;
}

// What decides the estimate.
Json experiment_json(const CaseSpec& spec) {
  Json json = Json::object();
  json["suite"] = spec.suite;
  json["system"] = spec.system;
  json["profile"] = spec.profile;
  json["backend"] = spec.backend ? Json(*spec.backend) : Json(nullptr);
  json["overrides"] = Json(spec.overrides);
  json["data_kind"] = to_text(spec.data_kind);
  json["dataset"] = spec.dataset;
  json["data_source"] = spec.data_source;
  json["data_seed"] = spec.data_seed ? Json(*spec.data_seed) : Json(nullptr);
  json["system_seed"] = spec.system_seed;
  json["threads"] = spec.threads;
  return json;
}

// Letters, digits and a few marks that are safe in file names of every system.
std::string safe(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool is_kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    name += is_kept ? c : '_';
  }
  return name;
}

// Takes members out of an object one by one; what is left over is unknown.
class Reader {
 public:
  Reader(Json json, std::string_view where) : json_(std::move(json)), where_(where) {}

  template <class T>
  void take(const char* name, T& value) {
    const auto found = json_.find(name);
    if (found == json_.end()) {
      problem(fmt::format(R"(key "{}" is missing)", name));
      return;
    }
    try {
      found->get_to(value);
    } catch (const Json::exception&) {
      problem(fmt::format(R"(key "{}" has a value of the wrong type)", name));
    }
    json_.erase(name);
  }

  template <class T>
  void take_optional(const char* name, std::optional<T>& value) {
    value.reset();
    if (json_.contains(name) && json_[name].is_null()) {
      json_.erase(name);
    } else {
      take(name, value.emplace());
    }
  }

  [[nodiscard]] Result<void> finish() {
    for (const auto& item : json_.items()) problem(fmt::format(R"(unknown key "{}")", item.key()));
    if (problems_.empty()) return {};
    return fail(ErrorCode::kInvalid, problems_, where_, "a case as `run` writes it");
  }

  void problem(const std::string& text) { problems_ += (problems_.empty() ? "" : "; ") + text; }

 private:
  Json json_;
  std::string where_;
  std::string problems_;
};

}  // namespace

std::string_view to_text(DataKind kind) {
  if (kind == DataKind::kGraph) return "graph";
  return kind == DataKind::kSimulated ? "simulated" : "recorded";
}

std::string case_id(const CaseSpec& spec) {
  std::string name = safe(spec.dataset);
  name += fmt::format("-s{}", spec.data_seed.value_or(spec.system_seed));
  name += fmt::format(".{}@{}", safe(spec.system), safe(spec.profile));
  if (spec.backend) name += fmt::format(".{}", safe(*spec.backend));
  return fmt::format("{}-{}", name, results::short_digest(experiment_json(spec).dump()));
}

std::string to_json(const CaseSpec& spec) {
  Json json = experiment_json(spec);
  json["limits"] = {{"time_s", spec.limits.time_s}, {"memory_mib", spec.limits.memory_mib}};
  json["data_digest"] = spec.data_digest;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<CaseSpec> case_spec_from_json(std::string_view text, std::string_view where) {
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) {
    return fail(ErrorCode::kMalformed, "not a JSON object", std::string(where),
                "a case as `run` writes it");
  }
  Reader reader(std::move(json), where);
  CaseSpec spec;
  std::string kind;
  Json limits = Json::object();
  reader.take("suite", spec.suite);
  reader.take("system", spec.system);
  reader.take("profile", spec.profile);
  reader.take_optional("backend", spec.backend);
  reader.take("overrides", spec.overrides);
  reader.take("data_kind", kind);
  reader.take("dataset", spec.dataset);
  reader.take("data_source", spec.data_source);
  reader.take_optional("data_seed", spec.data_seed);
  reader.take("system_seed", spec.system_seed);
  reader.take("threads", spec.threads);
  reader.take("limits", limits);
  reader.take("data_digest", spec.data_digest);
  const std::optional<DataKind> known_kind = data_kind_from(kind);
  if (!known_kind) reader.problem("data_kind is none of simulated, recorded, graph");
  spec.data_kind = known_kind.value_or(DataKind::kRecorded);
  if (spec.data_kind == DataKind::kSimulated && !spec.data_seed) {
    reader.problem("simulated data need a data_seed");
  }
  if (spec.threads < 1) reader.problem("threads is below 1");
  if (const Result<void> done = reader.finish(); !done) return tl::make_unexpected(done.error());

  Reader limit_reader(std::move(limits), fmt::format("{}: limits", where));
  limit_reader.take("time_s", spec.limits.time_s);
  limit_reader.take("memory_mib", spec.limits.memory_mib);
  const Result<void> done = limit_reader.finish();
  if (!done) return tl::make_unexpected(done.error());
  return spec;
}

Result<CaseSpec> read_case_spec(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return fail(ErrorCode::kNotFound, "cannot be opened", path.string(),
                "a case as `run` writes it");
  }
  std::ostringstream text;
  text << file.rdbuf();
  return case_spec_from_json(text.str(), path.string());
}

}  // namespace corridor::runner
