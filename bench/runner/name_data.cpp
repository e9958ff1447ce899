#include "bench/runner/name_data.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <utility>

namespace corridor::runner {
namespace {

namespace fs = std::filesystem;

bool is_file(const DataItem& item) { return fs::path(item.source).is_absolute(); }

// "folder/folder/name" with `num_folders` of the folders the file lies in.
std::string with_folders(const DataItem& item, std::size_t num_folders) {
  std::string name = item.name;
  fs::path folder = fs::path(item.source).parent_path();
  for (std::size_t i = 0; i < num_folders && folder.has_relative_path(); ++i) {
    name.insert(0, folder.filename().string() + "/");
    folder = folder.parent_path();
  }
  return name;
}

std::size_t num_parts(const fs::path& path) {
  return static_cast<std::size_t>(std::distance(path.begin(), path.end()));
}

// Another file of this name and folder: they differ in their suffix only.
bool has_sibling(const std::vector<DataItem>& items, const DataItem& item) {
  const auto is_sibling = [&](const DataItem& other) {
    return other.source != item.source && other.name == item.name &&
           fs::path(other.source).parent_path() == fs::path(item.source).parent_path();
  };
  return is_file(item) && std::any_of(items.begin(), items.end(), is_sibling);
}

std::vector<DataItem> without_repeats(std::vector<DataItem> items) {
  std::vector<DataItem> once;
  for (DataItem& item : items) {
    const auto is_same = [&](const DataItem& other) {
      return other.kind == item.kind && other.source == item.source;
    };
    if (std::none_of(once.begin(), once.end(), is_same)) once.push_back(std::move(item));
  }
  return once;
}

}  // namespace

std::vector<DataItem> with_own_names(std::vector<DataItem> items) {
  items = without_repeats(std::move(items));
  const std::vector<DataItem> given = items;
  for (DataItem& item : items) {
    if (has_sibling(given, item)) item.name = fs::path(item.source).filename();
  }
  std::vector<std::string> names;
  std::size_t num_folders_max = 0;
  for (const DataItem& item : items) {
    names.push_back(item.name);
    num_folders_max = std::max(num_folders_max, num_parts(item.source));
  }
  for (std::size_t num_folders = 1; num_folders < num_folders_max; ++num_folders) {
    const std::vector<std::string> before = names;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const bool is_shared = std::count(before.begin(), before.end(), before[i]) > 1;
      if (is_shared && is_file(items[i])) names[i] = with_folders(items[i], num_folders);
    }
  }
  for (std::size_t i = 0; i < items.size(); ++i) items[i].name = names[i];
  return items;
}

}  // namespace corridor::runner
