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

Result<RecordedGraph> record_graph(const GraphOf& graph, const catalog::DataDirs& dirs) {
  const CaseSpec spec = case_of(graph);
  const Result<CaseData> data = load_case_data(spec, dirs);
  if (!data) return tl::make_unexpected(of_graph(graph, data.error()));
  RecordedGraph recorded;
  const backend::BackEnd* back_end = nullptr;  // the system's, as long as the system lives
  const auto system = make_system(spec, *data, [&](std::unique_ptr<backend::BackEnd> own) {
    auto recorder = solve::make_recording(std::move(own), recorded.recording);
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
  recorded.recording.final_estimate = back_end->estimate();
  recorded.num_dropped_factors = solve::drop_unsolved_end(recorded.recording);
  if (recorded.recording.steps.empty()) {
    return fail(ErrorCode::kInvalid, "the system never has its graph solved", to_text(graph),
                "data in which it closes a loop, or solves without");
  }
  return recorded;
}

}  // namespace corridor::runner
