// Loading a pose graph with what is known about it: by a catalogued name, by the name of a walk
// (datasets/simulation/manhattan_walk.hpp), or by its path.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/catalog/catalog.hpp"
#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/core/result.hpp"

namespace corridor::catalog {

struct LoadedGraph {
  formats::PoseGraph graph;
  // In ascending order of the poses' numbers; empty where the truth is not known or not here.
  std::vector<formats::PoseGraph::Vertex> true_poses;
  std::optional<double> best_chi2;  // of CatalogEntry, also for its file given by path
  std::string name;                 // the catalogue's, the walk's, or the file's without suffix
  std::string digest;               // of the graph and its true poses
};

// Whether the name is that of a graph; else it means a log, or nothing.
bool is_graph_name(std::string_view name_or_path, const Catalog& catalog);

// By name the file must have the catalogue's checksum, and so must the true poses if they are
// there; by path true poses are those beside the file (formats::true_poses_beside).
Result<LoadedGraph> load_graph(std::string_view name_or_path, const DataDirs& dirs,
                               const Catalog& catalog);

}  // namespace corridor::catalog
