// The picture of a Bayes tree: where its boxes stand and what it says.
#include "reports/figures/tree_figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

#include "reports/figures/raster.hpp"
#include "reports/figures/tree_layout.hpp"

namespace corridor::figures {
namespace {

using backend::TreeSnapshot;
using graph::pose_key;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kExact_px = 1e-9;

struct RandomTree {
  std::vector<int> parents;
  std::vector<double> widths_px;
};

RandomTree random_tree() {
  RandomTree tree;
  const int num_boxes = *rc::gen::inRange(1, 40);
  for (int box = 0; box < num_boxes; ++box) {
    tree.parents.push_back(*rc::gen::inRange(kNoParent, box));
    tree.widths_px.push_back(*rc::gen::inRange(20, 200));
  }
  return tree;
}

RC_GTEST_PROP(TreeLayout, KeepsBoxesOfARowApartAndInside, ()) {
  const RandomTree tree = random_tree();
  const TreeLayout layout = lay_out_tree(tree.parents, tree.widths_px);
  for (std::size_t a = 0; a < tree.parents.size(); ++a) {
    const double half_px = tree.widths_px[a] / 2;
    RC_ASSERT(layout.centers_px[a] - half_px > -kExact_px);
    RC_ASSERT(layout.centers_px[a] + half_px < layout.width_px + kExact_px);
    RC_ASSERT(layout.top_px(a) + kTreeBoxHeight_px < layout.height_px + kExact_px);
    for (std::size_t b = 0; b < a; ++b) {
      if (layout.depths[a] != layout.depths[b]) continue;
      const double apart_px = std::abs(layout.centers_px[a] - layout.centers_px[b]);
      RC_ASSERT(apart_px > half_px + tree.widths_px[b] / 2 + kTreeGap_px - kExact_px);
    }
  }
}

RC_GTEST_PROP(TreeLayout, PutsEveryParentInTheRowAbove, ()) {
  const RandomTree tree = random_tree();
  const TreeLayout layout = lay_out_tree(tree.parents, tree.widths_px);
  for (std::size_t box = 0; box < tree.parents.size(); ++box) {
    const int parent = tree.parents[box];
    RC_ASSERT(layout.depths[box] ==
              (parent == kNoParent ? 0 : layout.depths[static_cast<std::size_t>(parent)] + 1));
  }
}

TEST(TreeLayout, PutsAParentAboveTheMiddleOfItsChildren) {
  const TreeLayout layout = lay_out_tree({kNoParent, 0, 0}, {40, 50, 50});
  EXPECT_NEAR(layout.centers_px[0], (layout.centers_px[1] + layout.centers_px[2]) / 2, kExact_px);
  EXPECT_LT(layout.centers_px[1], layout.centers_px[2]);
}

TEST(TreeLayout, PutsANarrowChildUnderTheMiddleOfAWideParent) {
  const TreeLayout layout = lay_out_tree({kNoParent, 0}, {200, 50});
  EXPECT_NEAR(layout.centers_px[0], 100, kExact_px);
  EXPECT_NEAR(layout.centers_px[1], 100, kExact_px);
}

TreeSnapshot::Clique clique(std::vector<graph::Key> frontals, std::vector<graph::Key> separator,
                            int parent, std::int64_t birth, std::int64_t elimination) {
  return {std::move(frontals), std::move(separator), parent, birth, elimination};
}

TEST(TreeFigure, NamesFrontalsAndSeparatorAndEveryStateThatOccursAndNoOther) {
  const TreeSnapshot before{{clique({pose_key(1)}, {}, TreeSnapshot::kNoParent, 1, 1),
                             clique({pose_key(0)}, {pose_key(1)}, 0, 2, 2)}};
  const TreeSnapshot after{{clique({pose_key(1), pose_key(2)}, {}, TreeSnapshot::kNoParent, 3, 3),
                            clique({pose_key(0)}, {pose_key(1)}, 0, 2, 2)}};
  const std::string svg = tree_svg("T", before, after);
  for (const char* text : {">x1<", ">x0 : x1<", ">x1 x2<", "taken out by", "new: ordered",
                           "untouched:", "axis orphan", "dimension-head"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_THAT(svg, Not(HasSubstr("eliminated again where")));
  const TreeSnapshot again{{clique({pose_key(1)}, {}, TreeSnapshot::kNoParent, 1, 9),
                            clique({pose_key(0)}, {pose_key(1)}, 0, 2, 2)}};
  EXPECT_THAT(tree_svg("T", before, again), HasSubstr("eliminated again where"));
  EXPECT_THAT(tree_svg("T", before, again), Not(HasSubstr("taken out by")));
}

TEST(TreeFigure, OfNothingAndWithATitleThatIsMarkupStaysWellFormed) {
  EXPECT_TRUE(png_from_svg(tree_svg("</text><b> & " + std::string(300, 'x'), {}, {}), 1));
}

}  // namespace
}  // namespace corridor::figures
