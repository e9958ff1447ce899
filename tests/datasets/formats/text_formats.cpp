#include "tests/datasets/formats/text_formats.hpp"

#include <utility>

#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/formats/maps/ros_map.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "datasets/formats/trajectories/trajectory_io.hpp"
#include "tests/datasets/formats/golden_support.hpp"

namespace corridor::formats::test {
namespace {

template <class T, class Count, class Notes>
Outcome outcome_of(const Result<T>& read, Count count, Notes notes) {
  if (!read) return {false, 0, read.error().to_line()};
  return {true, count(*read), joined(notes(*read))};
}

// The same wherever the file lay.
Outcome without_folder(Outcome outcome, const ScratchFolder& folder) {
  const std::string path = folder.path().string();
  for (std::size_t at = outcome.said.find(path); at != std::string::npos;
       at = outcome.said.find(path)) {
    outcome.said.erase(at, path.size());
  }
  return outcome;
}

TextFormat log_format(const std::string& name, const std::string& file, const std::string& text,
                      const std::string& robot_toml = "") {
  return {name, text, [=](const std::string& bytes) {
            const ScratchFolder folder;
            write_text(folder / file, bytes);
            if (!robot_toml.empty()) write_text(folder / "a.robot.toml", robot_toml);
            return without_folder(read_as_log(folder / file), folder);
          }};
}

TextFormat trajectory_format(const std::string& name, const std::string& file,
                             const std::string& text, const std::string& times = "") {
  return {name, text, [=](const std::string& bytes) {
            const ScratchFolder folder;
            write_text(folder / file, bytes);
            if (!times.empty()) write_text(folder / "a.times", times);
            return outcome_of(
                read_trajectory(folder / file),
                [](const ReadTrajectory& read) { return read.trajectory.size(); },
                [](const ReadTrajectory& read) { return read.notes; });
          }};
}

TextFormat graph_format(const std::string& name, const std::string& file) {
  return {name, read_text(golden_file("pose_graph/" + file)), [=](const std::string& bytes) {
            const ScratchFolder folder;
            write_text(folder / file, bytes);
            return outcome_of(
                read_pose_graph(folder / file),
                [](const PoseGraph& graph) { return graph.vertices.size() + graph.edges.size(); },
                [](const PoseGraph& graph) { return graph.notes; });
          }};
}

TextFormat relations_format() {
  return {"relations", read_text(golden_file("relations/two.relations")),
          [](const std::string& bytes) {
            const ScratchFolder folder;
            write_text(folder / "a.relations", bytes);
            return outcome_of(
                read_relations(folder / "a.relations"),
                [](const std::vector<Relation>& relations) { return relations.size(); },
                [](const std::vector<Relation>&) { return std::vector<std::string>{}; });
          }};
}

TextFormat map_format() {
  const auto [yaml, image] = golden_parts("ros_map/small.yaml");
  const std::string pixels = image;
  return {"ros_map", yaml + "\n", [pixels](const std::string& bytes) {
            const ScratchFolder folder;
            write_text(folder / "a.yaml", bytes);
            write_text(folder / "101", pixels);
            return outcome_of(
                read_ros_map(folder / "a.yaml"),
                [](const GridMap& map) {
                  return static_cast<std::size_t>(map.num_columns() * map.num_rows());
                },
                [](const GridMap&) { return std::vector<std::string>{}; });
          }};
}

}  // namespace

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

Outcome read_as_log(const std::filesystem::path& path) {
  return outcome_of(
      read_log(path), [](const SensorLog& log) { return log.events.size(); },
      [](const SensorLog& log) { return log.provenance.notes; });
}

std::vector<TextFormat> text_formats() {
  const auto [ticks_robot, ticks] = golden_parts("ticks/two-rows.dat");
  const auto [kitti, times] = golden_parts("kitti/five.kitti");
  return {
      log_format("flaser", "a.clf", read_text(golden_file("carmen/flaser.clf"))),
      log_format("robotlaser", "a.clf", read_text(golden_file("carmen/robotlaser.clf"))),
      log_format("ticks", "a.dat", ticks, ticks_robot),
      trajectory_format("tum", "a.tum", read_text(golden_file("tum/five.tum"))),
      trajectory_format("kitti", "a.kitti", kitti + "\n", times),
      trajectory_format("euroc", "a.csv", read_text(golden_file("euroc/ground-truth.csv"))),
      trajectory_format("carmen_trajectory", "a.clf",
                        read_text(golden_file("carmen_trajectory/flaser.clf"))),
      graph_format("g2o", "square.g2o"),
      graph_format("toro", "square.graph"),
      relations_format(),
      map_format(),
  };
}

}  // namespace corridor::formats::test
