#include "bench/runner/record_graph.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "bench/runner/case_data.hpp"
#include "bench/runner/case_system.hpp"
#include "bench/runner/drive.hpp"

namespace corridor::runner {
namespace {

Error of_graph(const GraphOf& graph, Error error) {
  if (error.where.empty()) error.where = to_text(graph);
  return error;
}

}  // namespace

Result<solve::Recording> record_graph(const GraphOf& graph, const catalog::DataDirs& dirs) {
  const CaseSpec spec = case_of(graph);
  const Result<CaseData> data = load_case_data(spec, dirs);
  if (!data) return tl::make_unexpected(of_graph(graph, data.error()));
  solve::Recording recording;
  const backend::BackEnd* back_end = nullptr;  // the system's, as long as the system lives
  const auto system = make_system(spec, *data, [&](std::unique_ptr<backend::BackEnd> own) {
    auto recorder = solve::make_recording(std::move(own), recording);
    back_end = recorder.get();
    return recorder;
  });
  if (!system) return tl::make_unexpected(of_graph(graph, system.error()));
  const Drive run = drive(**system, data->log);
  if (run.status != results::CaseStatus::kOk) {
    return fail(
        ErrorCode::kInvalid,
        fmt::format("the system ended as {}: {}", results::to_text(run.status), run.status_message),
        to_text(graph), "data that the system gets through");
  }
  if (recording.steps.empty()) {
    return fail(ErrorCode::kInvalid, "the system made no graph", to_text(graph), "data with scans");
  }
  recording.final_estimate = back_end->estimate();
  return recording;
}

}  // namespace corridor::runner
