#include "bench/results/result_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <type_traits>
#include <utility>

#include "bench/results/result_keys.hpp"

namespace corridor::results {
namespace {

using Json = nlohmann::ordered_json;

// --- writing -------------------------------------------------------------------------------------

Json json_of(const std::string& value) { return value; }
Json json_of(CaseStatus value) { return to_text(value); }
Json json_of(int value) { return value; }
Json json_of(std::int64_t value) { return value; }
Json json_of(std::uint64_t value) { return value; }
Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <class T>
Json json_of(const std::optional<T>& value);

template <class T>
Json json_of(const std::map<std::string, T>& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = json_of(value);
  return json;
}

Json json_of(const KeyDistance& key) {
  return {{"true_m", json_of(key.true_m)},
          {"measured_m", json_of(key.measured_m)},
          {"error_m", json_of(key.error_m)},
          {"sigma_m", json_of(key.sigma_m)},
          {"status", key.status}};
}

Json json_of(const KeyAngle& key) {
  return {{"true_deg", json_of(key.true_deg)},
          {"measured_deg", json_of(key.measured_deg)},
          {"error_deg", json_of(key.error_deg)},
          {"sigma_deg", json_of(key.sigma_deg)},
          {"status", key.status}};
}

Json json_of(const KeyDistances& keys) {
  return {{"a", json_of(keys.a)},
          {"b", json_of(keys.b)},
          {"c", json_of(keys.c)},
          {"alpha", json_of(keys.alpha)}};
}

Json json_of(const std::vector<std::string>& texts) { return texts; }

Json json_of(const std::vector<StageTimes>& stages) {
  Json json = Json::array();
  for (const StageTimes& stage : stages) {
    json.push_back({{"name", stage.name},
                    {"count", stage.count},
                    {"total_s", json_of(stage.total_s)},
                    {"p50_us", json_of(stage.p50_us)},
                    {"p95_us", json_of(stage.p95_us)},
                    {"p99_us", json_of(stage.p99_us)},
                    {"max_us", json_of(stage.max_us)}});
  }
  return json;
}

template <class T>
Json json_of(const std::optional<T>& value) {
  return value ? json_of(*value) : Json(nullptr);
}

// --- reading: false = not of the type expected ---------------------------------------------------

bool read(const Json& json, std::string& value) {
  if (json.is_string()) value = json.get<std::string>();
  return json.is_string();
}

bool read(const Json& json, double& value) {
  if (json.is_number()) value = json.get<double>();
  return json.is_number();
}

template <class T>
requires std::is_integral_v<T>
bool read(const Json& json, T& value) {
  if (!json.is_number_integer()) return false;
  if (json.is_number_unsigned()) {
    const auto number = json.get<std::uint64_t>();
    value = static_cast<T>(number);
    return std::in_range<T>(number);
  }
  const auto number = json.get<std::int64_t>();
  value = static_cast<T>(number);
  return std::in_range<T>(number);
}

bool read(const Json& json, CaseStatus& value) {
  std::string text;
  if (!read(json, text)) return false;
  const std::optional<CaseStatus> status = case_status_from_text(text);
  if (status) value = *status;
  return status.has_value();
}

bool read(const Json& json, KeyDistance& key);
bool read(const Json& json, KeyAngle& key);
bool read(const Json& json, KeyDistances& keys);
bool read(const Json& json, StageTimes& stage);
template <class T>
bool read(const Json& json, std::optional<T>& value);

template <class T>
bool read_member(const Json& json, const char* name, T& value) {
  const auto found = json.find(name);
  return found == json.end() || read(*found, value);
}

template <class T>
bool read(const Json& json, std::map<std::string, T>& values) {
  if (!json.is_object()) return false;
  values.clear();
  for (const auto& [name, member] : json.items()) {
    if (!read(member, values[name])) return false;
  }
  return true;
}

bool read(const Json& json, KeyDistance& key) {
  return json.is_object() && read_member(json, "true_m", key.true_m) &&
         read_member(json, "measured_m", key.measured_m) &&
         read_member(json, "error_m", key.error_m) && read_member(json, "sigma_m", key.sigma_m) &&
         read_member(json, "status", key.status);
}

bool read(const Json& json, KeyAngle& key) {
  return json.is_object() && read_member(json, "true_deg", key.true_deg) &&
         read_member(json, "measured_deg", key.measured_deg) &&
         read_member(json, "error_deg", key.error_deg) &&
         read_member(json, "sigma_deg", key.sigma_deg) && read_member(json, "status", key.status);
}

bool read(const Json& json, KeyDistances& keys) {
  return json.is_object() && read_member(json, "a", keys.a) && read_member(json, "b", keys.b) &&
         read_member(json, "c", keys.c) && read_member(json, "alpha", keys.alpha);
}

bool read(const Json& json, StageTimes& stage) {
  return json.is_object() && read_member(json, "name", stage.name) &&
         read_member(json, "count", stage.count) && read_member(json, "total_s", stage.total_s) &&
         read_member(json, "p50_us", stage.p50_us) && read_member(json, "p95_us", stage.p95_us) &&
         read_member(json, "p99_us", stage.p99_us) && read_member(json, "max_us", stage.max_us);
}

template <class T>
bool read(const Json& json, std::vector<T>& values) {
  if (!json.is_array()) return false;
  values.clear();
  for (const Json& member : json) {
    if (!read(member, values.emplace_back())) return false;
  }
  return true;
}

template <class T>
bool read(const Json& json, std::optional<T>& value) {
  value.reset();
  return json.is_null() || read(json, value.emplace());
}

}  // namespace

std::vector<ResultKey> result_keys() {
  std::vector<ResultKey> keys;
  const RunResult result;
  visit_keys(result, [&](const ResultKey& key, const auto&) { keys.push_back(key); });
  return keys;
}

std::string to_json(const RunResult& result) {
  Json json = Json::object();
  visit_keys(result,
             [&](const ResultKey& key, const auto& field) { json[key.name] = json_of(field); });
  // Text that is not UTF-8 (a message with a file's name in it) is shown with replacement marks.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<RunResult> result_from_json(std::string_view text, std::string_view where) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) {
    return fail(ErrorCode::kMalformed, "not a JSON object", std::string(where), "a result record");
  }
  RunResult result;
  std::string wrong;
  visit_keys(result, [&](const ResultKey& key, auto& field) {
    const auto found = json.find(key.name);
    if (wrong.empty() && found != json.end() && !read(*found, field)) wrong = key.name;
  });
  if (!wrong.empty()) {
    return fail(ErrorCode::kInvalid,
                fmt::format(R"(key "{}" has a value of the wrong type)", wrong), std::string(where),
                "a result record");
  }
  if (!json.contains("status") || !json.contains("case_id")) {
    return fail(ErrorCode::kInvalid, R"(keys "case_id" and "status" are not both there)",
                std::string(where), "a result record");
  }
  return result;
}

Result<RunResult> read_result(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return fail(ErrorCode::kNotFound, "cannot be opened", path.string(), "a result.json");
  }
  std::ostringstream text;
  text << file.rdbuf();
  return result_from_json(text.str(), path.string());
}

}  // namespace corridor::results
