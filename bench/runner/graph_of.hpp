// Names of the graphs that SLAM systems make: graph-of:SYSTEM[@PROFILE]:DATA[:SEED].
// The colon after graph-of comes first and decides; a file of such a name is given as
// ./graph-of:...
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "bench/runner/case_spec.hpp"
#include "bench/runner/systems.hpp"
#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

struct GraphOf {
  SystemChoice system;  // one that takes a back-end
  // Simulated with a seed, or recorded without one.
  DataKind data_kind = DataKind::kSimulated;
  std::string data;  // name or path of a scenario or log
  std::optional<std::uint64_t> seed;

  bool operator==(const GraphOf&) const = default;
};

// Whether a name is meant as one of these, well spelt or not.
bool is_graph_of(std::string_view name);

// The Error says in one line what of the name is wrong.
Result<GraphOf> graph_of_from(const std::string& name, const catalog::Catalog& known);

// The one spelling of each: with its profile.
std::string to_text(const GraphOf& graph);

// The system's own case on that data: what record_graph() does, without an output.
CaseSpec case_of(const GraphOf& graph);

}  // namespace corridor::runner
