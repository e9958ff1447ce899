#include "reports/figures/tree_layout.hpp"

#include <algorithm>
#include <cstddef>

namespace corridor::figures {
namespace {

// Of every box, the width of what hangs below it, itself included; the last entry is that of all
// roots side by side.
struct SubtreeWidths {
  std::vector<double> own_px, below_px;
};

std::size_t slot_of_parent(const std::vector<int>& parents, std::size_t box) {
  return parents[box] == kNoParent ? parents.size() : static_cast<std::size_t>(parents[box]);
}

SubtreeWidths subtree_widths(const std::vector<int>& parents,
                             const std::vector<double>& widths_px) {
  SubtreeWidths widths{widths_px, std::vector<double>(parents.size() + 1, 0.0)};
  widths.own_px.push_back(0);
  for (std::size_t box = parents.size(); box-- > 0;) {
    widths.own_px[box] = std::max(widths.own_px[box], widths.below_px[box]);
    double& of_siblings_px = widths.below_px[slot_of_parent(parents, box)];
    of_siblings_px += (of_siblings_px > 0 ? kTreeGap_px : 0) + widths.own_px[box];
  }
  widths.own_px.back() = widths.below_px.back();
  return widths;
}

}  // namespace

TreeLayout lay_out_tree(const std::vector<int>& parents, const std::vector<double>& widths_px) {
  const std::size_t num_boxes = parents.size();
  const SubtreeWidths widths = subtree_widths(parents, widths_px);
  TreeLayout layout;
  layout.width_px = widths.own_px.back();
  layout.centers_px.assign(num_boxes + 1, layout.width_px / 2);
  layout.depths.assign(num_boxes, 0);
  // Of every box, and of nothing above the roots, where its next child begins.
  std::vector<double> next_px(num_boxes + 1, 0.0);
  for (std::size_t box = 0; box < num_boxes; ++box) {
    const std::size_t parent = slot_of_parent(parents, box);
    layout.centers_px[box] = next_px[parent] + widths.own_px[box] / 2;
    next_px[parent] += widths.own_px[box] + kTreeGap_px;
    next_px[box] = layout.centers_px[box] - widths.below_px[box] / 2;
    if (parents[box] != kNoParent) layout.depths[box] = layout.depths[parent] + 1;
    layout.height_px = std::max(layout.height_px, layout.top_px(box) + kTreeBoxHeight_px);
  }
  layout.centers_px.pop_back();
  return layout;
}

}  // namespace corridor::figures
