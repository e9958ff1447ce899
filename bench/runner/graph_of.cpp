#include "bench/runner/graph_of.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <system_error>

#include "bench/runner/data_kind.hpp"

namespace corridor::runner {
namespace {

constexpr std::string_view kPrefix = "graph-of:";
constexpr const char* kForm = "graph-of:SYSTEM[@PROFILE]:DATA[:SEED]";

bool is_number(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
}

Result<SystemChoice> graph_system_from(std::string_view text, const std::string& name) {
  const Result<SystemChoice> choice = parse_system_choice(text);
  if (!choice) return fail(choice.error().code, choice.error().what, name, choice.error().expected);
  const Result<SystemInfo> info = find_system(choice->system);
  if (!info->takes_graphs() && info->default_backend) return choice;
  return fail(ErrorCode::kInvalid, fmt::format("system {} makes no graph", choice->system), name,
              "a system that is given logs and has a back-end");
}

// Takes the seed off, if `data` is a scenario's: the numbers behind its last colon.
Result<void> take_seed(const std::string& name, GraphOf& graph) {
  const std::size_t colon = graph.data.rfind(':');
  if (colon == std::string::npos) return {};
  const std::string digits = graph.data.substr(colon + 1);
  std::uint64_t seed = 0;
  if (!is_number(digits)) return {};
  if (std::from_chars(digits.data(), digits.data() + digits.size(), seed).ec != std::errc()) {
    return fail(ErrorCode::kInvalid, fmt::format("seed {} is too large", digits), name, kForm);
  }
  graph.seed = seed;
  graph.data.resize(colon);
  return {};
}

Result<void> check_seed(const std::string& name, const GraphOf& graph) {
  const bool is_simulated = graph.data_kind == DataKind::kSimulated;
  if (is_simulated && !graph.seed) {
    return fail(ErrorCode::kInvalid, fmt::format("scenario {} without a seed", graph.data), name,
                fmt::format("{}{}:{}:SEED", kPrefix, graph.system.system, graph.data));
  }
  if (!is_simulated && graph.seed) {
    return fail(ErrorCode::kInvalid, fmt::format("{} is recorded and has no seed", graph.data),
                name, fmt::format("{}{}:{}", kPrefix, graph.system.system, graph.data));
  }
  return {};
}

}  // namespace

bool is_graph_of(std::string_view name) { return name.starts_with(kPrefix); }

Result<GraphOf> graph_of_from(const std::string& name, const catalog::Catalog& known) {
  const std::size_t colon = name.find(':', kPrefix.size());
  if (!is_graph_of(name) || colon == std::string::npos || colon + 1 == name.size()) {
    return fail(ErrorCode::kInvalid, "names no data", name, kForm);
  }
  GraphOf graph;
  const auto system = graph_system_from(
      std::string_view(name).substr(kPrefix.size(), colon - kPrefix.size()), name);
  if (!system) return tl::make_unexpected(system.error());
  graph.system = *system;
  graph.data = name.substr(colon + 1);
  if (const auto taken = take_seed(name, graph); !taken) {
    return tl::make_unexpected(taken.error());
  }
  const auto of_name = [&name](Error error) {
    if (error.where.empty()) error.where = name;
    return tl::make_unexpected(std::move(error));
  };
  const auto no_log = [&] {
    return fail(ErrorCode::kInvalid, fmt::format("{} is a graph", graph.data), name,
                "a scenario or a log");
  };
  // Told apart here: a name within a name within a name has no end.
  if (is_graph_of(graph.data)) return no_log();
  const Result<DataKind> kind = kind_of_data(graph.data, known);
  if (!kind) return of_name(kind.error());
  if (*kind == DataKind::kGraph) return no_log();
  graph.data_kind = *kind;
  if (const auto good = check_seed(name, graph); !good) return tl::make_unexpected(good.error());
  return graph;
}

std::string to_text(const GraphOf& graph) {
  return fmt::format("{}{}@{}:{}{}", kPrefix, graph.system.system, graph.system.profile, graph.data,
                     graph.seed ? fmt::format(":{}", *graph.seed) : "");
}

CaseSpec case_of(const GraphOf& graph) {
  CaseSpec spec;
  spec.system = graph.system.system;
  spec.profile = graph.system.profile;
  spec.backend = find_system(graph.system.system)->default_backend;
  spec.data_kind = graph.data_kind;
  spec.dataset = graph.data;
  spec.data_source = graph.data;
  spec.data_seed = graph.seed;
  spec.system_seed = graph.seed.value_or(spec.system_seed);
  return spec;
}

}  // namespace corridor::runner
