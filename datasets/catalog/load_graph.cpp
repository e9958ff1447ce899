#include "datasets/catalog/load_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "datasets/catalog/catalogued_files.hpp"
#include "datasets/catalog/checksum.hpp"
#include "datasets/catalog/find_folder.hpp"
#include "datasets/catalog/sha256.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "datasets/formats/graphs/true_poses.hpp"
#include "datasets/simulation/manhattan_walk.hpp"

namespace corridor::catalog {
namespace {

namespace fs = std::filesystem;

LoadedGraph made_walk(const simulation::WalkName& walk, std::string_view name) {
  simulation::WalkGraph made = simulation::walk_graph(walk);
  LoadedGraph loaded;
  for (const formats::PoseGraph::Vertex& vertex : made.graph.vertices) {
    loaded.true_poses.push_back({vertex.id, made.true_poses[vertex.id]});
  }
  loaded.digest =
      to_hex(sha256_of(formats::pose_graph_text(made.graph, formats::GraphFormat::kG2o)));
  loaded.graph = std::move(made.graph);
  loaded.name = name;
  return loaded;
}

// Adds the true poses of a file, and the file to the digest.
Result<void> take_true_poses(const fs::path& path, LoadedGraph& loaded) {
  const Result<std::string> sha256 = sha256_of_file(path);
  if (!sha256) return tl::make_unexpected(sha256.error());
  auto poses = formats::read_true_poses(path, loaded.graph);
  if (!poses) return tl::make_unexpected(poses.error());
  loaded.true_poses = std::move(*poses);
  loaded.digest = to_hex(sha256_of(fmt::format("graph {}\ntruth {}\n", loaded.digest, *sha256)));
  return {};
}

// The companion with the true poses, if the entry has one.
const DataFile* true_poses_of(const CatalogEntry& entry) {
  const fs::path wanted = formats::true_poses_beside(entry.files.front().path).lexically_normal();
  const auto found =
      std::find_if(entry.companions.begin(), entry.companions.end(),
                   [&](const DataFile& file) { return file.path.lexically_normal() == wanted; });
  return found == entry.companions.end() ? nullptr : &*found;
}

Result<LoadedGraph> load_entry(const CatalogEntry& entry, const DataDirs& dirs) {
  if (!entry.is_graph()) {
    return fail(ErrorCode::kUnsupported, fmt::format("data set {} is no pose graph", entry.name),
                "catalogue", "g2o or toro");
  }
  const auto folder = folder_of(entry, dirs);
  if (!folder) return tl::make_unexpected(folder.error());
  const auto checked = check_files(entry, *folder, false);
  if (!checked) return tl::make_unexpected(checked.error());
  auto graph = formats::read_pose_graph(*folder / entry.files.front().path);
  if (!graph) return tl::make_unexpected(graph.error());
  LoadedGraph loaded{
      std::move(*graph), {}, entry.best_chi2, entry.name, entry.files.front().sha256};
  const DataFile* truth = true_poses_of(entry);
  if (truth == nullptr || !is_file(*folder / truth->path)) return loaded;
  const auto sha256 = checksum_of(*folder / truth->path, *truth);
  if (!sha256) return tl::make_unexpected(sha256.error());
  if (*sha256 != truth->sha256) {
    return fail(ErrorCode::kInvalid, fmt::format("data set {}: SHA-256 is {}", entry.name, *sha256),
                (*folder / truth->path).string(), truth->sha256);
  }
  if (auto taken = take_true_poses(*folder / truth->path, loaded); !taken) {
    return tl::make_unexpected(taken.error());
  }
  return loaded;
}

Result<LoadedGraph> load_file(const fs::path& path, const Catalog& catalog) {
  auto graph = formats::read_pose_graph(path);
  if (!graph) return tl::make_unexpected(graph.error());
  const Result<std::string> sha256 = sha256_of_file(path);
  if (!sha256) return tl::make_unexpected(sha256.error());
  LoadedGraph loaded{std::move(*graph), {}, {}, path.stem().string(), *sha256};
  for (const CatalogEntry& entry : catalog.entries) {
    if (entry.is_graph() && entry.files.front().sha256 == *sha256) {
      loaded.best_chi2 = entry.best_chi2;
    }
  }
  const fs::path truth = formats::true_poses_beside(path);
  if (!is_file(truth)) return loaded;
  if (auto taken = take_true_poses(truth, loaded); !taken) {
    return tl::make_unexpected(taken.error());
  }
  return loaded;
}

}  // namespace

bool is_graph_name(std::string_view name_or_path, const Catalog& catalog) {
  if (const CatalogEntry* entry = catalog.find(name_or_path)) return entry->is_graph();
  return simulation::walk_name_from(name_or_path).has_value() ||
         formats::graph_format_from_suffix(name_or_path).has_value();
}

Result<LoadedGraph> load_graph(std::string_view name_or_path, const DataDirs& dirs,
                               const Catalog& catalog) {
  if (const CatalogEntry* entry = catalog.find(name_or_path)) return load_entry(*entry, dirs);
  if (const auto walk = simulation::walk_name_from(name_or_path)) {
    return made_walk(*walk, name_or_path);
  }
  return load_file(fs::path(name_or_path), catalog);
}

}  // namespace corridor::catalog
