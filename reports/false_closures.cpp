#include "reports/false_closures.hpp"

#include <array>
#include <functional>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "reports/graph_cases.hpp"

namespace corridor::reports {
namespace {

using results::RunResult;

// Parameters of the disturbance and of what is done against it.
constexpr std::array<std::string_view, 5> kOwnParameters = {
    "false_closures", "false_pairs", "robust", "kernel_width", "inlier_probability"};

bool is_disturbed(const RunResult& result) {
  const std::string method = method_of(result);
  return false_share_of(result) > 0 || (!method.empty() && method != "none");
}

// Suite, system, back-end and all parameters but those above.
using Setting =
    std::tuple<std::string, std::string, std::string, std::map<std::string, std::string>>;

Setting setting_of(const RunResult& result) {
  std::map<std::string, std::string> others = result.parameters;
  for (const std::string_view name : kOwnParameters) others.erase(std::string(name));
  return {result.suite, result.system, result.backend.value_or(""), std::move(others)};
}

// Whether a case is one of those, or their baseline.
std::function<bool(const RunResult&)> belongs_to_false_closures(const Cases& graphs) {
  std::set<Setting> disturbed;
  for (const Case& entry : graphs.all()) {
    if (is_disturbed(entry.result)) disturbed.insert(setting_of(entry.result));
  }
  return [disturbed = std::move(disturbed)](const RunResult& result) {
    return disturbed.contains(setting_of(result));
  };
}

}  // namespace

bool is_found_again(const RunResult& result) { return is_within(result, kFoundAgain_ratio); }

std::string method_of(const RunResult& result) {
  const auto found = result.parameters.find("robust");
  return found == result.parameters.end() ? std::string() : found->second;
}

double false_share_of(const RunResult& result) { return number_of(result, "false_closures"); }

Cases with_false_closures(const Cases& graphs) {
  return graphs.only(belongs_to_false_closures(graphs));
}

Cases without_false_closures(const Cases& graphs) {
  return graphs.only(std::not_fn(belongs_to_false_closures(graphs)));
}

}  // namespace corridor::reports
