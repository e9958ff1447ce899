#include "tests/architecture/include_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace corridor::architecture {

namespace {

using Prefixes = std::vector<std::string_view>;

struct Arrow {
  std::string_view from;  // the longest prefix of a file's path decides
  Prefixes to;            // besides the file's own part, which is always allowed
};

// Vocabulary and numerics that a rival may share with the fusion system: never a matcher or a map.
const Prefixes kShared{"slam/core/", "slam/motion/", "slam/linear/", "slam/graph/",
                       "slam/backend/"};

const std::vector<Arrow>& arrows() {
  static const std::vector<Arrow> table{
      {"slam/core/", {}},
      {"slam/linear/", {"slam/core/"}},
      {"slam/motion/", {"slam/core/"}},
      {"slam/graph/", {"slam/core/", "slam/motion/"}},
      {"slam/mapping/", {"slam/core/"}},
      {"slam/matching/", {"slam/core/", "slam/mapping/"}},
      {"slam/backend/", {"slam/core/", "slam/linear/", "slam/graph/"}},
      {"slam/fusion/", {"slam/"}},
      {"baselines/dead_reckoning/", kShared},
      {"baselines/gmapping/", kShared},
      {"baselines/karto/", kShared},
      {"baselines/mrpt/", kShared},
      {"datasets/", {"slam/core/", "slam/graph/"}},
      {"bench/", {"slam/", "baselines/", "datasets/"}},
      {"bench/external/", {"slam/core/", "datasets/"}},
      {"bench/statistics/", {"slam/core/"}},
      {"bench/results/", {"slam/core/", "bench/statistics/", "datasets/catalog/sha256"}},
      {"bench/cli/", {"bench/", "slam/", "baselines/", "datasets/", "reports/"}},
      {"bench/main.cpp", {"bench/", "slam/", "baselines/", "datasets/", "reports/"}},
      {"reports/", {"bench/results/", "bench/statistics/", "datasets/", "slam/core/"}},
      // The picture of a Bayes tree is made from its snapshot, which is plain values.
      {"reports/figures/tree_figure",
       {"reports/", "slam/backend/isam2/tree_snapshot", "slam/graph/key"}},
      {"tests/", {"slam/", "baselines/", "datasets/", "bench/", "reports/"}},
  };
  return table;
}

struct Door {
  std::string_view package;  // prefix of the included path
  Prefixes files;            // prefixes of the paths that may include it
  // Light packages, and wrappers that only their own folder includes.
  bool is_allowed_in_headers = false;
};

const std::vector<Door>& doors() {
  static const std::vector<Door> table{
      {"mrpt/", {"datasets/formats/rawlog/", "baselines/mrpt/"}},
      {"rosbag/", {"datasets/formats/bag/rosbag_door"}},
      {"ros/", {"datasets/formats/bag/rosbag_door"}},
      {"nav_msgs/", {"datasets/formats/bag/rosbag_door"}},
      {"sensor_msgs/", {"datasets/formats/bag/rosbag_door"}},
      {"bzlib.h", {"datasets/formats/bag/bag_chunk"}},
      {"lz4", {"datasets/formats/bag/bag_chunk"}},
      {"open3d/", {"bench/metrics/map_cloud"}},
      {"ceres/", {"slam/backend/ceres/"}},
      {"glog/", {"slam/backend/ceres/"}},
      {"cholmod", {"slam/linear/"}},
      {"amd.h", {"slam/linear/minimum_degree"}},
      {"ccolamd", {"slam/linear/"}},
      {"suitesparse/", {"slam/linear/"}},
      {"Eigen/CholmodSupport", {"slam/linear/"}},
      {"benchmark/", {"bench/micro/"}, true},
      {"sqlite3", {"bench/results/"}, true},
      {"Random123/", {"slam/core/rng"}},
      {"CLI/", {"bench/main.cpp", "bench/cli/"}, true},
      {"kainjow/", {"reports/"}},
      {"librsvg/", {"reports/figures/raster"}},
      {"cairo", {"reports/figures/raster"}},
      {"curl/", {"datasets/catalog/download"}},
      {"openssl/", {"datasets/catalog/sha256"}},
      {"yaml-cpp/", {"datasets/formats/maps/"}},
      {"png.h", {"datasets/formats/maps/", "reports/"}},
      {"zlib.h", {"datasets/formats/"}},
      {"toml++/", {"datasets/", "bench/"}, true},
      {"nlohmann/", {"datasets/", "bench/", "reports/"}, true},
  };
  return table;
}

const Arrow* arrow_of(std::string_view path) {
  const Arrow* best = nullptr;
  for (const Arrow& arrow : arrows()) {
    const bool is_longer = best == nullptr || arrow.from.size() > best->from.size();
    if (is_longer && path.starts_with(arrow.from)) best = &arrow;
  }
  return best;
}

std::string source_of(const std::string& header) {
  return header.substr(0, header.size() - 4) + ".cpp";
}

}  // namespace

std::vector<std::string> forbidden_arrows(const SourceTree& tree) {
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    if (!file.is_cpp()) continue;
    const Arrow* arrow = arrow_of(file.path);
    if (arrow == nullptr) {
      found.push_back(at_line(file, 1, "lies in no known part of the tree"));
      continue;
    }
    for (const Include& include : includes_of(file)) {
      if (!include.is_quoted) continue;
      // A file that CMake makes is named by its template.
      if (!tree.has(include.path) && !tree.has(include.path + ".in")) {
        found.push_back(at_line(file, include.line_number,
                                fmt::format("\"{}\" is no file seen from the root", include.path)));
      } else if (!include.path.starts_with(arrow->from) &&
                 !starts_with_any(include.path, arrow->to)) {
        found.push_back(at_line(file, include.line_number,
                                fmt::format("{} must not include {}", arrow->from, include.path)));
      }
    }
  }
  return found;
}

std::vector<std::string> packages_outside_their_door(const SourceTree& tree) {
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    if (!file.is_cpp() || file.path.starts_with("tests/")) continue;
    for (const Include& include : includes_of(file)) {
      const auto door = std::ranges::find_if(
          doors(), [&](const Door& each) { return include.path.starts_with(each.package); });
      if (include.is_quoted || door == doors().end()) continue;
      if (!starts_with_any(file.path, door->files)) {
        found.push_back(at_line(file, include.line_number,
                                fmt::format("<{}> belongs behind its door", include.path)));
      } else if (file.path.ends_with(".hpp") && !door->is_allowed_in_headers) {
        found.push_back(at_line(file, include.line_number,
                                fmt::format("<{}> belongs in a .cpp only", include.path)));
      }
    }
  }
  return found;
}

std::vector<std::string> own_headers_not_first(const SourceTree& tree) {
  std::vector<std::string> found;
  for (const SourceFile& file : tree.files) {
    if (!file.path.ends_with(".hpp")) continue;
    const SourceFile* source = tree.find(source_of(file.path));
    if (source == nullptr) continue;
    const std::vector<Include> includes = includes_of(*source);
    if (includes.empty() || includes.front().path != file.path) {
      found.push_back(at_line(*source, 1, fmt::format("does not include {} first", file.path)));
    }
  }
  return found;
}

std::vector<std::string> headers_without_source(const SourceTree& tree) {
  std::vector<std::string> headers;
  for (const SourceFile& file : tree.files) {
    if (file.path.ends_with(".hpp") && !tree.has(source_of(file.path)))
      headers.push_back(file.path);
  }
  return headers;
}

}  // namespace corridor::architecture
