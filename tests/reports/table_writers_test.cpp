// One table in its four forms, against golden files written by hand.
#include "reports/tables/writers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "reports/tables/condensed.hpp"
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

// Two rows on one data set, of which nothing is known about the world.
Table table_with_constants() {
  Table table = small_table();
  table.columns.insert(table.columns.begin(), {"data set", "dataset", ColumnKind::kText});
  table.columns.push_back({"in the paper [m]", "paper_m", ColumnKind::kNumber});
  for (std::vector<Cell>& row : table.rows) {
    row.insert(row.begin(), "corridor_1");
    row.push_back(Missing{"other world"});
  }
  return table;
}

TEST(TableWriters, SayOnceWhatIsTheSameInEveryRow) {
  const std::string common = "In every row: data set: corridor_1; in the paper [m]: other world.";
  EXPECT_EQ(condense(table_with_constants()).common, common);
  for (const std::string& text :
       {to_markdown(table_with_constants()), to_latex(table_with_constants()),
        to_html(table_with_constants())}) {
    const std::size_t first = text.find("corridor");
    ASSERT_NE(first, std::string::npos);
    EXPECT_EQ(text.find("corridor", first + 1), std::string::npos);
  }
}

TEST(TableWriters, CsvKeepsColumnsThatAreTheSameInEveryRow) {
  EXPECT_THAT(to_csv(table_with_constants()),
              ::testing::AllOf(::testing::StartsWith("dataset,system,"),
                               ::testing::HasSubstr("corridor_1,fusion,")));
}

TEST(Condense, LeavesATableOfOneRowAndTheLastColumnAlone) {
  Table table = table_with_constants();
  table.rows.resize(1);
  EXPECT_EQ(condense(table).table.columns.size(), table.columns.size());
  Table same = table;
  same.columns.resize(1);
  same.rows = {{"x"}, {"x"}};
  EXPECT_EQ(condense(same).table.columns.size(), 1U);
  EXPECT_EQ(condense(same).common, "");
}

TEST(Condense, LeavesOutOptionalColumnsWithoutAValueAndSaysNothingOfThem) {
  Table table = small_table();
  table.columns.push_back({"in the paper [m]", "paper_m", ColumnKind::kNumber, true});
  for (std::vector<Cell>& row : table.rows) row.push_back(Missing{"other world"});
  EXPECT_EQ(to_markdown(table), golden("small.md"));
  EXPECT_THAT(to_csv(table), ::testing::HasSubstr(",paper_m\r\n"));
  table.rows[1].back() = Number{0.1949, 4};
  EXPECT_THAT(to_markdown(table), ::testing::HasSubstr("| other world |"));
}

TEST(Condense, KeepsEstimatesEvenIfTheyAreEqual) {
  Table table;
  table.columns = {{"system", "system", ColumnKind::kText}, {"x", "x", ColumnKind::kEstimate}};
  table.rows = {{"a", Estimate{1, {}, {}, 1, 1}}, {"b", Estimate{1, {}, {}, 1, 1}}};
  EXPECT_EQ(condense(table).table.columns.size(), 2U);
}

TEST(NumberText, RoundsToTensAndThousandsBelowZeroDecimals) {
  EXPECT_EQ(number_text(249271.3, -3), "249000");
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
