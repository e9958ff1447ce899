// A whole report from a run directory made by the test.
#include "reports/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "bench/results/results_store.hpp"
#include "reports/html/csp_hash.hpp"
#include "reports/html/page.hpp"
#include "reports/html/verdict.hpp"
#include "reports/tables/condensed.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/writers.hpp"
#include "tests/reports/synthetic_run.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::reports {
namespace {

namespace fs = std::filesystem;
using corridor::testing::ScratchFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::map<std::string, std::string> all_files(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = read_text(entry.path());
    }
  }
  return files;
}

// One report for all tests that only look.
class Report : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<ScratchFolder>();
    results::RunResult lost = testing::synthetic_result(testing::paper_like_run(), {"karto"}, 99);
    lost.status = results::CaseStatus::kTimeout;
    lost.status_message = "stopped after 60 s";
    lost.final_scores = {};
    testing::write_synthetic_run(testing::paper_like_run(), scratch_->path() / "run", {lost});
    const auto written = write_report({scratch_->path() / "run"}, scratch_->path() / "out");
    ASSERT_TRUE(written) << written.error().to_line();
    page_ = read_text(scratch_->path() / "out" / "index.html");
  }
  static void TearDownTestSuite() { scratch_.reset(); }

  static std::string table(const std::string& name) {
    return read_text(scratch_->path() / "out" / "tables" / name);
  }

  static std::unique_ptr<ScratchFolder> scratch_;
  static std::string page_;
};

std::unique_ptr<ScratchFolder> Report::scratch_;
std::string Report::page_;

TEST_F(Report, HoldsEveryTableInThreeFormsAndEveryFigureInTwo) {
  const fs::path out = scratch_->path() / "out";
  for (const char* name : {"table1", "table1-errors", "table2", "comparison", "cost", "stages",
                           "outcomes", "failures", "not-measured"}) {
    for (const char* suffix : {".md", ".csv", ".tex"}) {
      EXPECT_GT(fs::file_size(out / "tables" / (std::string(name) + suffix)), 0U) << name;
    }
  }
  for (const char* name : {"environment", "trajectories", "maps", "errors", "stages"}) {
    for (const char* suffix : {".svg", ".png"}) {
      EXPECT_GT(
          fs::file_size(out / "figures" / (std::string(name) + "-synthetic-corridor" + suffix)), 0U)
          << name;
    }
  }
}

TEST_F(Report, ShowsThePapersFiguresBesideOurs) {
  EXPECT_THAT(table("table1.csv"),
              AllOf(HasSubstr("13.415"), HasSubstr("13.897"), HasSubstr("89.236")));
  EXPECT_THAT(table("table2.csv"),
              AllOf(HasSubstr("4.5489"), HasSubstr("0.6032"), HasSubstr("0.674")));
}

TEST_F(Report, MarksTheBestOnlyOnce) {
  const std::string markdown = table("table2.md");
  const std::regex best_position(R"(\| fusion \| \*\*)");
  EXPECT_TRUE(std::regex_search(markdown, best_position));
  EXPECT_FALSE(std::regex_search(markdown, std::regex(R"(\| karto \| \*\*)")));
}

TEST_F(Report, GivesAFailureARowWithItsMessageAndACount) {
  EXPECT_THAT(table("failures.csv"),
              AllOf(HasSubstr("karto"), HasSubstr("timeout"), HasSubstr("stopped after 60 s")));
  EXPECT_THAT(table("table2.md"), HasSubstr("(8/9)"));
}

TEST_F(Report, StatesWhatWasNotMeasured) {
  EXPECT_THAT(
      table("not-measured.csv"),
      HasSubstr("synthetic-corridor,all,does not apply,\"relation error, translation mean"));
}

TEST_F(Report, PageLoadsNothing) {
  EXPECT_THAT(page_, Not(HasSubstr("<script")));
  EXPECT_THAT(page_, Not(HasSubstr("<link")));
  EXPECT_THAT(page_, Not(HasSubstr("@import")));
  EXPECT_THAT(page_, Not(HasSubstr("style=\"")));
  const std::regex loads(R"re((src|href)="((https?:)?//|javascript:|file:)[^"]*")re");
  EXPECT_FALSE(std::regex_search(page_, loads));
}

TEST_F(Report, PageAllowsOnlyItsOwnStyleSheetByItsHash) {
  std::smatch policy;
  ASSERT_TRUE(std::regex_search(
      page_, policy,
      std::regex(R"re(default-src 'none'; style-src '(sha256-[A-Za-z0-9+/=]+)')re")));
  const std::size_t begin = page_.find("<style>") + 7;
  const std::string style = page_.substr(begin, page_.find("</style>") - begin);
  EXPECT_EQ(policy[1].str(), html::csp_hash(style));
  EXPECT_EQ(page_.find("<style", begin), std::string::npos);
}

TEST_F(Report, PageNamesMachineRevisionCommandsAndRawFiles) {
  for (const char* text :
       {"Test CPU", "0000000",
        "corridor-bench run synthetic --jobs 1 --seed 1 --seeds 8 --out synthetic",
        "../run/results.sqlite", "tables/table1.csv", "figures/maps-synthetic", "num_particles",
        "runs/synthetic-karto-3/result.json"}) {
    EXPECT_THAT(page_, HasSubstr(text));
  }
}

TEST_F(Report, EveryRelativeLinkLeadsToAFile) {
  const std::regex link(R"re(href="([^"#][^"]*)")re");
  for (std::sregex_iterator it(page_.begin(), page_.end(), link), end; it != end; ++it) {
    const std::string target = (*it)[1];
    if (target.starts_with("data:") || target.find("synthetic-karto-99") != std::string::npos)
      continue;
    EXPECT_TRUE(fs::exists(scratch_->path() / "out" / target)) << target;
  }
}

TEST(WriteReport, GivesTheSameBytesTwice) {
  const ScratchFolder scratch;
  testing::SyntheticRun run = testing::paper_like_run();
  run.num_worlds = 6;
  testing::write_synthetic_run(run, scratch.path() / "run");
  ASSERT_TRUE(write_report({scratch.path() / "run"}, scratch.path() / "one"));
  ASSERT_TRUE(write_report({scratch.path() / "run"}, scratch.path() / "two"));
  EXPECT_EQ(all_files(scratch.path() / "one"), all_files(scratch.path() / "two"));
}

TEST(WriteReport, OfAnEmptyStoreIsAnErrorAndLeavesNothing) {
  const ScratchFolder scratch;
  ASSERT_TRUE(results::ResultsStore::open(scratch.path() / "results.sqlite"));
  const auto written = write_report({scratch.path()}, scratch.path() / "out");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().to_line(), HasSubstr("no result"));
  EXPECT_FALSE(fs::exists(scratch.path() / "out"));
}

TEST(WriteReport, OfNoDirectoryOrAMissingOneIsAnError) {
  const ScratchFolder scratch;
  EXPECT_FALSE(write_report({}, scratch.path() / "out"));
  const auto written = write_report({scratch.path() / "absent"}, scratch.path() / "out");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().to_line(), HasSubstr("absent"));
}

TEST(WriteReport, ReadsRecordsWhereThereIsNoStore) {
  const ScratchFolder scratch;
  testing::SyntheticRun run = testing::paper_like_run();
  run.num_worlds = 2;
  testing::write_synthetic_run(run, scratch.path() / "run");
  fs::remove(scratch.path() / "run" / "results.sqlite");
  const auto written = write_report({scratch.path() / "run"}, scratch.path() / "out");
  ASSERT_TRUE(written) << written.error().to_line();
}

TEST(WriteReport, ShowsAnUnreadableFileAsAProblemAndGoesOn) {
  const ScratchFolder scratch;
  testing::SyntheticRun run = testing::paper_like_run();
  run.num_worlds = 1;
  testing::write_synthetic_run(run, scratch.path() / "run");
  scratch.write("run/runs/synthetic-karto-1/final.tum", "not a trajectory\n");
  ASSERT_TRUE(write_report({scratch.path() / "run"}, scratch.path() / "out"));
  EXPECT_THAT(read_text(scratch.path() / "out" / "index.html"),
              AllOf(HasSubstr("Files that could not be read"), HasSubstr("final.tum:1")));
}

TEST(WriteReport, KeepsHostileNamesHarmlessEverywhere) {
  const ScratchFolder scratch;
  const std::vector<std::string> names = {"</script><script>alert(1)</script>",
                                          "\"onload=\"alert(1)",
                                          "50 % _of_ $x$ & |y| \\end{table}",
                                          std::string(300, 'x'),
                                          "\u202Eright to left \u0645\u0631\u062D\u0628\u0627",
                                          "../../../up",
                                          "\xFF\xFE"};
  testing::SyntheticRun run;
  run.num_worlds = 1;
  run.has_files = false;
  std::vector<results::RunResult> extra;
  for (const std::string& name : names) {
    results::RunResult result = testing::synthetic_result(run, {"karto", 0.1}, 1);
    result.system = result.dataset = result.profile = result.suite = name;
    result.status = results::CaseStatus::kFailed;
    result.status_message = result.git_revision = result.machine_id = name;
    result.parameters = {{name, name}};
    result.case_id = "case-" + std::to_string(extra.size());
    extra.push_back(result);
  }
  std::vector<Case> all;
  for (const results::RunResult& result : extra) all.push_back({result, scratch.path() / "runs"});
  const Cases cases(all, {}, {scratch.path()});
  const std::vector<tables::Table> report = tables::report_tables(cases);
  std::vector<std::string> problems = names;
  const std::vector<figures::Figure> drawn = figures::report_figures(cases, problems);
  const auto page = html::render_page({&cases, &report, &drawn, &problems, scratch.path()});
  ASSERT_TRUE(page) << page.error().to_line();
  EXPECT_THAT(*page, Not(HasSubstr("<script")));
  EXPECT_THAT(*page, Not(HasSubstr("\"onload")));
  EXPECT_THAT(*page, HasSubstr("&lt;script&gt;"));
  for (const tables::Table& table : report) {
    const auto num_columns = tables::condense(table).table.columns.size();
    std::istringstream lines(tables::to_markdown(table));
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("|")) continue;
      const std::string plain = std::regex_replace(line, std::regex(R"(\\.)"), "");
      EXPECT_EQ(static_cast<std::size_t>(std::count(plain.begin(), plain.end(), '|')),
                num_columns + 1);
    }
  }
}

}  // namespace
}  // namespace corridor::reports
