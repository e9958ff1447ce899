// `solve --tree`: the picture of the Bayes tree, which the page on back-ends shows as well.
#include <gtest/gtest.h>

#include "tests/bench/cli/program.hpp"
#include "tests/support/documents.hpp"

namespace corridor::testing {
namespace {

constexpr const char* kPair =
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";

// A straight drive.
std::string line_of(int num_poses) {
  std::string text = "VERTEX_SE2 0 0 0 0\n";
  for (int i = 1; i < num_poses; ++i) {
    text += "VERTEX_SE2 " + std::to_string(i) + " " + std::to_string(i) + " 0 0\n";
    text += "EDGE_SE2 " + std::to_string(i - 1) + " " + std::to_string(i) + " 1 0 0 1 0 0 1 0 1\n";
  }
  return text;
}

TEST(SolveTree, DrawsThePictureOfTheBackEndsPageAgainByteForByte) {
  const std::string page = text_of_document("slam/backend/README.md");
  const auto commands = examples_in(page, "sh");
  ASSERT_EQ(commands.size(), 1U);
  const ScratchFolder folder;
  folder.write("slam/backend/pictures/square-walk.g2o",
               text_of_document("slam/backend/pictures/square-walk.g2o"));
  folder.write("script.sh", commands.front());
  const std::string command = "cd '" + folder.path().string() +
                              "' && PATH='" CORRIDOR_BINARY_DIR
                              "/bin':\"$PATH\" sh -e script.sh >said 2>&1 </dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0) << text_of(folder / "said");
  EXPECT_EQ(text_of(folder / "slam/backend/pictures/bayes-tree.svg"),
            text_of_document("slam/backend/pictures/bayes-tree.svg"));
  EXPECT_NE(page.find("(pictures/bayes-tree.svg)"), std::string::npos);
}

TEST(SolveTree, DrawsAGraphOfOnePoseAndUpToTheLimit) {
  const ScratchFolder folder;
  folder.write("one.g2o", "VERTEX_SE2 0 0 0 0\n");
  folder.write("forty.g2o", line_of(40));
  for (const std::string graph : {"one", "forty"}) {
    const Answer answer =
        run_program(folder, "solve " + graph + ".g2o --backend isam2 --mode incremental --tree " +
                                graph + ".svg");
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    EXPECT_NE(text_of(folder / (graph + ".svg")).find("</svg>"), std::string::npos);
  }
}

TEST(SolveTree, DrawsTheSameUpdateWherePosesWaitForIt) {
  const ScratchFolder folder;
  folder.write("t.g2o", line_of(6));
  const Answer answer =
      run_program(folder, "solve t.g2o --backend isam2 --mode incremental --every 4 --tree t.svg");
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  const std::string svg = text_of(folder / "t.svg");
  EXPECT_NE(svg.find("x0"), std::string::npos);
  EXPECT_NE(svg.find("taken out by"), std::string::npos);
}

TEST(SolveTree, RefusesWhatHasNoUpdatesOrNoTreeOrCannotBeRead) {
  const ScratchFolder folder;
  folder.write("t.g2o", kPair);
  folder.write("long.g2o", line_of(41));
  const std::string with = "solve t.g2o --mode incremental --tree t.svg --backend ";
  for (const std::string back_end : {"gauss-newton", "fixed-lag", "ceres"}) {
    expect_refused(folder, with + back_end, {"--tree: " + back_end, "--backend isam2"});
  }
  expect_refused(folder, "solve t.g2o --backend isam2 --tree t.svg",
                 {"--tree", "--mode incremental"});
  expect_refused(folder, "solve long.g2o --backend isam2 --mode incremental --tree t.svg",
                 {"--tree", "41 poses", "at most 40 poses"});
  expect_refused(folder, "solve t.g2o --backend isam2 --mode incremental --tree t.png",
                 {"t.png", ".svg"});
  expect_refused(folder, "solve t.g2o --backend isam2 --mode incremental --tree no/t.svg",
                 {"no", "exist"});
}

}  // namespace
}  // namespace corridor::testing
