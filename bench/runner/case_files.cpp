#include "bench/runner/case_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <optional>
#include <system_error>

#include "bench/results/result_json.hpp"
#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/graphs/g2o_file.hpp"
#include "datasets/formats/maps/map_png.hpp"
#include "datasets/formats/maps/ros_map.hpp"
#include "datasets/formats/trajectories/tum.hpp"
#include "slam/graph/graph_source.hpp"

namespace corridor::runner {
namespace {

namespace fs = std::filesystem;

Result<void> write_map(const GridMap& map, const fs::path& folder, const std::string& stem) {
  if (map.empty()) return {};
  if (auto done = formats::write_ros_map(map, folder / stem); !done) return done;
  return formats::write_map_png(map, folder / (stem + ".png"));
}

std::string flag_text(const std::optional<bool>& flag) { return flag ? (*flag ? "1" : "0") : ""; }

Result<void> write_health(const std::vector<HealthSample>& health, const fs::path& path) {
  std::string text = "stamp_ns,is_slip_detected,is_degenerate\n";
  for (const HealthSample& sample : health) {
    text += fmt::format("{},{},{}\n", sample.stamp.nanoseconds, flag_text(sample.is_slip_detected),
                        flag_text(sample.is_degenerate));
  }
  return formats::write_file_atomically(path, std::string_view(text));
}

Result<void> write_data_truth(const CaseData& data, const fs::path& folder) {
  if (data.log.truth) {
    auto done = formats::write_tum(*data.log.truth, folder / "truth.tum");
    if (!done) return done;
  }
  if (!data.simulation_truth) return {};
  const std::string text = simulation::truth_toml(*data.simulation_truth);
  return formats::write_file_atomically(folder / "world.toml", std::string_view(text));
}

Result<void> write_estimate(const SlamEstimate& estimate, const fs::path& folder) {
  auto done = formats::write_tum(estimate.trajectory, folder / "final.tum");
  if (!done || !estimate.map) return done;
  return write_map(*estimate.map, folder, "map");
}

}  // namespace

fs::path case_folder(const fs::path& out, const std::string& case_id) {
  return out / "runs" / case_id;
}

fs::path partial_folder(const fs::path& folder) {
  return folder.parent_path() / fmt::format(".{}.partial", folder.filename().string());
}

Result<void> write_folder_atomically(
    const fs::path& folder, const std::function<Result<void>(const fs::path& temporary)>& write) {
  const fs::path temporary = partial_folder(folder);
  const fs::path older =
      folder.parent_path() / fmt::format(".{}.older", folder.filename().string());
  try {
    fs::remove_all(temporary);
    fs::create_directories(temporary);
    if (Result<void> done = write(temporary); !done) {
      fs::remove_all(temporary);
      return done;
    }
    fs::remove_all(older);
    if (fs::exists(folder)) fs::rename(folder, older);
    fs::rename(temporary, folder);
    fs::remove_all(older);
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove_all(temporary, ignored);
    return fail(ErrorCode::kUnreadable, error.code().message(), folder.string(),
                "a folder that can be written");
  }
  return {};
}

Result<void> write_record(const fs::path& folder, const CaseSpec& spec,
                          const results::RunResult& result, const std::string& log_text) {
  const std::string spec_text = to_json(spec);
  const std::string result_text = results::to_json(result);
  for (const auto& [name, text] :
       {std::pair("spec.json", &spec_text), std::pair("result.json", &result_text),
        std::pair("log.txt", &log_text)}) {
    auto done = formats::write_file_atomically(folder / name, std::string_view(*text));
    if (!done) return done;
  }
  return {};
}

Result<void> write_output(const fs::path& folder, const CaseOutput& output) {
  if (auto done = write_data_truth(*output.data, folder); !done) return done;
  if (auto done = formats::write_tum(output.run->online, folder / "online.tum"); !done) return done;
  if (!output.run->health.empty()) {
    if (auto done = write_health(output.run->health, folder / "health.csv"); !done) return done;
  }
  if (!output.run->estimate) return {};
  if (auto done = write_estimate(*output.run->estimate, folder); !done) return done;
  if (output.rendered_map != nullptr) {
    if (auto done = write_map(*output.rendered_map, folder, "rendered"); !done) return done;
  }
  const auto* source = dynamic_cast<const graph::GraphSource*>(output.system);
  if (source == nullptr) return {};
  return formats::write_g2o(source->solved_graph(), source->solved_values(), folder / "graph.g2o");
}

}  // namespace corridor::runner
