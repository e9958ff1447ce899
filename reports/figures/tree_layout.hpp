// Where the boxes of a drawn tree stand: one row per depth, parents in the middle above what hangs
// below them. It knows no contents, only widths.
#pragma once

#include <vector>

namespace corridor::figures {

inline constexpr int kNoParent = -1;
inline constexpr double kTreeBoxHeight_px = 30;
inline constexpr double kTreeRow_px = 58;  // from the top of a row to the next
inline constexpr double kTreeGap_px = 18;  // between boxes of a row

struct TreeLayout {
  std::vector<double> centers_px;  // of every box
  std::vector<int> depths;         // 0 for a root
  double width_px = 0;
  double height_px = 0;

  [[nodiscard]] double top_px(std::size_t box) const { return kTreeRow_px * depths[box]; }
};

// parents: of every box its parent's number, which is smaller, or kNoParent; several roots stand
// side by side. Siblings keep their order from left to right.
TreeLayout lay_out_tree(const std::vector<int>& parents, const std::vector<double>& widths_px);

}  // namespace corridor::figures
