#include "slam/core/nearest_names.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace corridor {
namespace {

constexpr std::size_t kNumNamesShown = 3;

// Letters to change, insert or take out, row by row of the table.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({changed, row[j] + 1, row[j - 1] + 1}));
    }
  }
  return row.back();
}

std::size_t distance(std::string_view misspelt, std::string_view name) {
  const bool is_part = misspelt.find(name) != std::string_view::npos ||
                       name.find(misspelt) != std::string_view::npos;
  return is_part ? 1 : edit_distance(misspelt, name);
}

}  // namespace

std::vector<std::string> nearest_names(std::string_view misspelt,
                                       const std::vector<std::string>& names) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (const std::string& name : names) ranked.emplace_back(distance(misspelt, name), name);
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string> nearest;
  for (std::size_t i = 0; i < std::min(kNumNamesShown, ranked.size()); ++i) {
    nearest.push_back(ranked[i].second);
  }
  return nearest;
}

}  // namespace corridor
