// One table in its four forms, against golden files written by hand.
#include "reports/tables/writers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/scratch_folder.hpp"

namespace corridor::tables {
namespace {

std::string golden(const std::string& name) {
  std::ifstream file(std::string(CORRIDOR_SOURCE_DIR) + "/tests/reports/golden/" + name,
                     std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

Table small_table() {
  Table table;
  table.id = "small";
  table.caption = "Errors of two systems";
  table.columns = {{"system", "system", ColumnKind::kText},
                   {"position [m]", "position_rmse_m", ColumnKind::kEstimate},
                   {"worst [m]", "worst_m", ColumnKind::kNumber}};
  table.rows = {{"fusion", Estimate{0.1 + 0.2, 0.25, 0.35, 10, 10, 3, true}, Number{0.5, 3}},
                {"a|b_c", Estimate{1.5, {}, {}, 2, 10, 3, false}, Missing{"not measured"}},
                {"lost, \"far\"", Missing{"not measurable (0/10)"}, Number{-1e-9, 3}}};
  table.notes = {"n = 10 worlds, 95 % intervals"};
  return table;
}

TEST(TableWriters, MarkdownEqualsTheGoldenFile) {
  EXPECT_EQ(to_markdown(small_table()), golden("small.md"));
}

TEST(TableWriters, CsvEqualsTheGoldenFileWithFullPrecision) {
  EXPECT_EQ(to_csv(small_table()), golden("small.csv"));
  EXPECT_THAT(to_csv(small_table()), ::testing::HasSubstr("0.30000000000000004"));
}

TEST(TableWriters, LatexEqualsTheGoldenFile) {
  EXPECT_EQ(to_latex(small_table()), golden("small.tex"));
}

TEST(TableWriters, HtmlEqualsTheGoldenFile) {
  EXPECT_EQ(to_html(small_table()), golden("small.html"));
}

TEST(NumberText, NeverWritesMinusZero) {
  EXPECT_EQ(number_text(-0.0001, 3), "0.000");
  EXPECT_EQ(number_text(-0.001, 3), "-0.001");
  EXPECT_EQ(number_text(2.0005, 0), "2");
}

TEST(TableWriters, LatexCompilesWithHostileNames) {
  if (std::system("pdflatex --version > /dev/null 2>&1") != 0 ||
      std::system("kpsewhich siunitx.sty > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "pdflatex with siunitx is not installed";
  }
  Table table = small_table();
  table.rows.push_back({R"(\end{document} %_$#&~^{}<>|"[x])",
                        Estimate{12.25, 12, 13, 6, 6, 3, true}, Missing{"50 % & _"}});
  const corridor::testing::ScratchFolder scratch;
  scratch.write("table.tex",
                "\\documentclass{article}\\usepackage[T1]{fontenc}\\usepackage[utf8]{inputenc}"
                "\\usepackage{booktabs,siunitx,textcomp}\\begin{document}\n" +
                    to_latex(table) + "\\end{document}\n");
  const std::string command = "cd '" + scratch.path().string() +
                              "' && pdflatex -interaction=nonstopmode -halt-on-error table.tex > "
                              "pdflatex.out 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace corridor::tables
