#include "reports/figures/tree_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <string_view>
#include <vector>

#include "reports/figures/svg.hpp"
#include "reports/figures/tree_layout.hpp"
#include "slam/graph/key.hpp"

namespace corridor::figures {
namespace {

using backend::CliqueFate;
using backend::TreeSnapshot;
using Clique = TreeSnapshot::Clique;

constexpr double kMargin_px = 20;
constexpr double kTitle_px = 44;  // room above the heads of the trees
constexpr double kHead_px = 24;   // room of a head
constexpr double kBetween_px = 56;
constexpr double kMinTree_px = 250;  // of one tree, so that heads and title have room
constexpr double kPadding_px = 12;   // of a text in its box
constexpr double kCorner_px = 9;
constexpr double kInset_px = 4;  // of the inner line of a double outline
constexpr double kMark_px = 6;
constexpr double kBaseline_px = 4.5;  // from the middle of a line of text down
constexpr double kLegendBox_px = 34;
constexpr double kLegendRow_px = 24;

// How the literature writes a variable: x7 is pose 7.
std::string short_name(graph::Key key) {
  constexpr std::array<char, graph::kNumVariableKinds> kLetters{'x', 'v', 'b', 's'};
  return fmt::format("{}{}", kLetters[static_cast<std::size_t>(key.kind)], key.index);
}

std::string joined(const std::vector<graph::Key>& keys) {
  std::vector<std::string> names;
  for (const graph::Key key : keys) names.push_back(short_name(key));
  return fmt::format("{}", fmt::join(names, " "));
}

std::string text_of(const Clique& clique) {
  const std::string frontals = joined(clique.frontals);
  return clique.separator.empty() ? frontals
                                  : fmt::format("{} : {}", frontals, joined(clique.separator));
}

std::set<graph::Key> variables_of(const TreeSnapshot& tree) {
  std::set<graph::Key> variables;
  for (const Clique& clique : tree.cliques) {
    variables.insert(clique.frontals.begin(), clique.frontals.end());
  }
  return variables;
}

struct Look {
  CliqueFate fate = CliqueFate::kUntouched;
  bool is_before = false;
};

void draw_box(Svg& svg, double x, double y, double width, double height, const Look& look) {
  switch (look.fate) {
    case CliqueFate::kUntouched:
      return svg.rect(x, y, width, height, "clique clique-kept", kCorner_px);
    case CliqueFate::kReplaced:
      return svg.rect(x, y, width, height,
                      look.is_before ? "clique clique-out" : "clique clique-new", kCorner_px);
    case CliqueFate::kEliminatedAgain:
      svg.rect(x, y, width, height, "clique", kCorner_px);
      svg.rect(x + kInset_px, y + kInset_px, width - 2 * kInset_px, height - 2 * kInset_px,
               "clique-again", kCorner_px - kInset_px);
      return;
  }
}

// One of the two trees with what it is compared with.
class DrawnTree {
 public:
  DrawnTree(const TreeSnapshot& tree, const TreeSnapshot& other, bool is_before)
      : tree_(tree), other_(other), known_(variables_of(other)), is_before_(is_before) {
    std::vector<int> parents;
    for (const Clique& clique : tree.cliques) {
      parents.push_back(clique.parent);
      widths_px_.push_back(text_width_px(text_of(clique)) + 2 * kPadding_px);
    }
    layout_ = lay_out_tree(parents, widths_px_);
  }

  [[nodiscard]] double width_px() const { return std::max(layout_.width_px, kMinTree_px); }
  [[nodiscard]] double height_px() const { return layout_.height_px; }

  // With its upper left corner there.
  void draw(Svg& svg, double left_px, double top_px) const {
    const double x_px = left_px + (width_px() - layout_.width_px) / 2;
    for (std::size_t box = 0; box < widths_px_.size(); ++box) draw_edge(svg, box, x_px, top_px);
    for (std::size_t box = 0; box < widths_px_.size(); ++box) draw_clique(svg, box, x_px, top_px);
  }

 private:
  [[nodiscard]] CliqueFate fate(std::size_t box) const {
    return fate_of(tree_.cliques[box], other_);
  }

  void draw_edge(Svg& svg, std::size_t box, double x_px, double y_px) const {
    if (tree_.cliques[box].parent == TreeSnapshot::kNoParent) return;
    const auto parent = static_cast<std::size_t>(tree_.cliques[box].parent);
    const bool is_orphan =
        fate(box) != CliqueFate::kReplaced && fate(parent) == CliqueFate::kReplaced;
    svg.line(x_px + layout_.centers_px[parent], y_px + layout_.top_px(parent) + kTreeBoxHeight_px,
             x_px + layout_.centers_px[box], y_px + layout_.top_px(box),
             is_orphan ? "axis orphan" : "axis");
  }

  void draw_clique(Svg& svg, std::size_t box, double x_px, double y_px) const {
    const Clique& clique = tree_.cliques[box];
    const double center_px = x_px + layout_.centers_px[box];
    const double top_px = y_px + layout_.top_px(box);
    const double left_px = center_px - widths_px_[box] / 2;
    draw_box(svg, left_px, top_px, widths_px_[box], kTreeBoxHeight_px, {fate(box), is_before_});
    svg.text(center_px, top_px + kTreeBoxHeight_px / 2 + kBaseline_px, text_of(clique), "",
             Anchor::kMiddle);
    const bool is_arrival =
        !is_before_ && std::any_of(clique.frontals.begin(), clique.frontals.end(),
                                   [&](graph::Key key) { return !known_.contains(key); });
    if (is_arrival) svg.marker(Marker::kDiamond, left_px, top_px, kMark_px, "dimension-head");
  }

  const TreeSnapshot& tree_;
  const TreeSnapshot& other_;
  std::set<graph::Key> known_;
  bool is_before_;
  std::vector<double> widths_px_;
  TreeLayout layout_;
};

struct LegendRow {
  Look look;
  std::string_view text;
};

constexpr std::array kLooks{
    LegendRow{{CliqueFate::kReplaced, true}, "taken out by the update"},
    LegendRow{{CliqueFate::kReplaced, false}, "new: ordered and eliminated by the update"},
    LegendRow{{CliqueFate::kEliminatedAgain, false},
              "eliminated again where it is, at another linearisation point"},
    LegendRow{{CliqueFate::kUntouched, false}, "untouched: the same numbers before and after"},
};
// Below the outlines: the mark of a new variable, the line of an orphan, how to read a box.
constexpr std::size_t kNumOtherRows = 3;
constexpr double kLegendWidth_px = 500;

// The outlines that these trees have.
std::vector<LegendRow> legend_of(const TreeSnapshot& before, const TreeSnapshot& after) {
  std::vector<LegendRow> rows;
  for (const LegendRow& row : kLooks) {
    const TreeSnapshot& tree = row.look.is_before ? before : after;
    const TreeSnapshot& other = row.look.is_before ? after : before;
    const bool occurs =
        std::any_of(tree.cliques.begin(), tree.cliques.end(),
                    [&](const Clique& clique) { return fate_of(clique, other) == row.look.fate; });
    if (occurs) rows.push_back(row);
  }
  return rows;
}

void draw_legend(Svg& svg, double x_px, double y_px, const std::vector<LegendRow>& looks) {
  constexpr double kBox_px = 16;
  const double text_x_px = x_px + kLegendBox_px + kPadding_px;
  double middle_px = y_px + kLegendRow_px / 2;
  const auto next = [&](std::string_view text) {
    svg.text(text_x_px, middle_px + kBaseline_px, text);
    middle_px += kLegendRow_px;
  };
  for (const LegendRow& row : looks) {
    draw_box(svg, x_px, middle_px - kBox_px / 2, kLegendBox_px, kBox_px, row.look);
    next(row.text);
  }
  svg.marker(Marker::kDiamond, x_px + kLegendBox_px / 2, middle_px, kMark_px, "dimension-head");
  next("eliminates a variable that is new");
  svg.line(x_px, middle_px, x_px + kLegendBox_px, middle_px, "axis orphan");
  next("orphan: stays as it is below what is eliminated anew");
  svg.text(x_px, middle_px + kBaseline_px, "a b : c", "strong");
  svg.text(text_x_px + kPadding_px, middle_px + kBaseline_px,
           "a clique that eliminates a and b; c is its separator");
}

}  // namespace

std::string tree_svg(const std::string& title, const TreeSnapshot& before,
                     const TreeSnapshot& after) {
  const DrawnTree left(before, after, true);
  const DrawnTree right(after, before, false);
  const std::vector<LegendRow> legend = legend_of(before, after);
  const double trees_px = left.width_px() + kBetween_px + right.width_px();
  const double inner_px = std::max(trees_px, kLegendWidth_px);
  const double height_px = std::max(left.height_px(), right.height_px());
  const double top_px = kTitle_px + kHead_px;
  const double legend_px = top_px + height_px + kMargin_px;
  Svg svg(
      "bayes-tree", inner_px + 2 * kMargin_px,
      legend_px + kLegendRow_px * static_cast<double>(legend.size() + kNumOtherRows) + kMargin_px,
      title, "Two trees of boxes, each with the variables that it eliminates and its separator");
  svg.text(kMargin_px, kMargin_px + kBaseline_px * 2, elided(title, inner_px), "title");
  const double left_px = kMargin_px + (inner_px - trees_px) / 2;
  const double right_px = left_px + left.width_px() + kBetween_px;
  svg.text(left_px + left.width_px() / 2, kTitle_px + kBaseline_px, "before", "strong",
           Anchor::kMiddle);
  svg.text(right_px + right.width_px() / 2, kTitle_px + kBaseline_px, "after", "strong",
           Anchor::kMiddle);
  left.draw(svg, left_px, top_px);
  right.draw(svg, right_px, top_px);
  const double middle_px = right_px - kBetween_px / 2;
  svg.line(middle_px, kTitle_px, middle_px, top_px + height_px, "grid");
  draw_legend(svg, kMargin_px, legend_px, legend);
  return svg.file();
}

}  // namespace corridor::figures
