// What the commands do when they are asked the right way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/results/results_store.hpp"
#include "tests/bench/cli/program.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::testing {
namespace {

namespace fs = std::filesystem;

TEST(List, GivesEveryKindAsTextAndAsOneJsonDocument) {
  const ScratchFolder folder;
  for (const std::string kind : {"systems", "profiles", "backends", "datasets", "scenarios",
                                 "suites", "metrics", "stages"}) {
    const Answer text = run_program(folder, "list " + kind);
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_GT(std::count(text.out.begin(), text.out.end(), '\n'), 1) << kind;
    const Answer json = run_program(folder, "list " + kind + " --json");
    const auto items = nlohmann::json::parse(json.out);
    EXPECT_EQ(json.err, "");
    ASSERT_TRUE(items.is_array() && !items.empty()) << kind;
    for (const auto& item : items) EXPECT_TRUE(item.contains("name")) << kind;
  }
}

TEST(List, MarksFamiliesOfScenariosAndSaysWhatTheirParametersMean) {
  const ScratchFolder folder;
  const Answer text = run_program(folder, "list scenarios");
  EXPECT_NE(text.out.find("corridor-range         of 9    The"), std::string::npos) << text.out;
  const auto items = nlohmann::json::parse(run_program(folder, "list scenarios --json").out);
  for (const auto& item : items) {
    EXPECT_EQ(item.at("family").is_null(), item.at("members").size() == 1) << item.at("name");
    for (const auto& row : item.at("parameters")) {
      for (const char* key : {"name", "type", "value", "unit", "range", "meaning"}) {
        EXPECT_TRUE(row.contains(key)) << item.at("name") << row;
      }
    }
  }
}

TEST(Help, NamesOnlyCommandsThatExist) {
  const ScratchFolder folder;
  const Answer help = run_program(folder, "--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command :
       {"list", "run", "run-case", "simulate", "convert", "evaluate", "report", "data"}) {
    EXPECT_NE(help.out.find(std::string("\n  ") + command + " "), std::string::npos) << command;
    EXPECT_EQ(run_program(folder, std::string(command) + " --help").exit_code, 0);
  }
}

TEST(Convert, SaysWhatTheTargetCannotHold) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out a.rawlog --quiet").exit_code, 0);
  const Answer answer = run_program(folder, "convert a.rawlog b.clf.gz");
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_NE(answer.out.find("lost: "), std::string::npos) << answer.out;
  EXPECT_NE(answer.out.find("IMU"), std::string::npos) << answer.out;
  EXPECT_TRUE(fs::exists(folder / "b.clf.gz"));
  EXPECT_TRUE(fs::exists(folder / "b.tum")) << "the truth goes along";
  EXPECT_EQ(text_of(folder / "b.truth.toml"), text_of(folder / "a.truth.toml"));
  const std::string truth = text_of(folder / "a.tum");
  EXPECT_EQ(run_program(folder, "convert a.rawlog a.clf").exit_code, 0);
  EXPECT_EQ(text_of(folder / "a.tum"), truth) << "one truth beside both";
}

TEST(Evaluate, GivesAHandComputedError) {
  const ScratchFolder folder;
  // First poses aligned; the second is 0.3 m too far to the left, the third 0.4 m too far ahead.
  folder.write("truth.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 2 0 0 0 0 0 1\n");
  folder.write("estimate.tum", "1 5 5 0 0 0 0 1\n2 6 5.3 0 0 0 0 1\n3 7.4 5 0 0 0 0 1\n");
  const Answer answer =
      run_program(folder, "evaluate --estimate estimate.tum --truth truth.tum --json");
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  const auto json = nlohmann::json::parse(answer.out);
  EXPECT_NEAR(json.at("position_rmse_m").get<double>(), std::sqrt((0.09 + 0.16) / 3), 1e-12);
  EXPECT_EQ(json.at("poses_matched"), 3);
  EXPECT_TRUE(json.at("relations_used").is_null());
}

TEST(Evaluate, GivesTheFiguresThatEvoGives) {
  const auto estimate = recorded_file("golden/r4.5-s1.karto.tum");
  const auto truth = recorded_file("corridor/r4.5-s1.tum");
  if (!estimate || !truth) GTEST_SKIP() << missing_data_message("golden/r4.5-s1.karto.tum");
  const ScratchFolder folder;
  const Answer answer = run_program(folder, "evaluate --json --estimate '" + estimate->string() +
                                                "' --truth '" + truth->string() + "'");
  const auto json = nlohmann::json::parse(answer.out);
  // evo's APE with origin alignment, as its golden file has it.
  EXPECT_NEAR(json.at("position_rmse_m").get<double>(), 0.804675, 1e-6);
  EXPECT_NEAR(json.at("angle_rmse_deg").get<double>(), 0.403437, 1e-6);
}

// A run of the smoke suite, one world.
Answer run_smoke(const ScratchFolder& folder, const std::string& options) {
  return run_program(folder, "run smoke --seeds 1 " + options);
}

TEST(Run, GivesTheSameTrajectoriesTwiceAndForAnyNumberOfJobs) {
  const ScratchFolder folder;
  const Answer first = run_smoke(folder, "--out one --jobs 1");
  ASSERT_EQ(first.exit_code, 0) << first.err << first.out;
  const Answer second = run_smoke(folder, "--out two --jobs 2");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  int num_compared = 0;
  for (const std::string& path : contents_of(folder / "one" / "runs")) {
    if (fs::path(path).extension() != ".tum" && fs::path(path).extension() != ".pgm" &&
        fs::path(path).extension() != ".g2o") {
      continue;
    }
    ++num_compared;
    EXPECT_EQ(text_of(folder / "one" / "runs" / path), text_of(folder / "two" / "runs" / path))
        << path;
  }
  EXPECT_GE(num_compared, 12);

  // Everything the layout of a run promises.
  for (const char* name : {"results.sqlite", "index.html", "tables", "figures", "log.txt"}) {
    EXPECT_TRUE(fs::exists(folder / "one" / name)) << name;
  }
  const auto store = results::ResultsStore::open_read_only(folder / "one" / "results.sqlite");
  ASSERT_TRUE(store.has_value());
  const std::vector<results::RunResult> records = store->read_all().value();
  for (const results::RunResult& result : records) {
    EXPECT_EQ(result.status, results::CaseStatus::kOk) << result.case_id;
    EXPECT_TRUE(result.final_scores.position_rmse_m.has_value()) << result.case_id;
    EXPECT_TRUE(result.online_scores.position_rmse_m.has_value()) << result.case_id;
    EXPECT_EQ(result.poses_matched, result.poses_expected) << result.case_id;
  }

  // Nothing is run again.
  const Answer resumed = run_smoke(folder, "--out one --resume --no-report");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.out.find(" 0 failed"), std::string::npos);
  EXPECT_EQ(resumed.out.find(" 0 kept"), std::string::npos) << resumed.out;

  // One case again from its own spec, over the old one.
  const std::string id = records.front().case_id;
  const std::string before = text_of(folder / "one" / "runs" / id / "final.tum");
  fs::copy_file(folder / "one" / "runs" / id / "spec.json", folder / "spec.json");
  EXPECT_EQ(run_program(folder, "run-case spec.json --out one").exit_code, 0);
  EXPECT_EQ(text_of(folder / "one" / "runs" / id / "final.tum"), before);

  // A report of two runs.
  EXPECT_EQ(run_program(folder, "report one two --out report").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "report" / "index.html"));
}

TEST(Run, SaysWhatIsInItsFolderFromRunsBefore) {
  const ScratchFolder folder;
  const Answer first = run_smoke(folder, "--system fusion-paper --out o --no-report");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(first.out.find("earlier runs"), std::string::npos) << first.out;
  const Answer again = run_smoke(folder, "--system fusion-paper --out o --no-report");
  EXPECT_EQ(again.out.find("earlier runs"), std::string::npos) << "its cases are replaced";
  const Answer other = run_smoke(folder, "--system fusion-paper --seed 9 --out o --no-report");
  EXPECT_NE(other.out.find("/o: 1 case of earlier runs (suite smoke) stays here"),
            std::string::npos)
      << other.out;
}

TEST(Run, LeavesAFolderToTheRunThatIsWritingToIt) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "o");
  const std::string holder = "flock o/.lock '" CORRIDOR_BINARY_DIR "/bin/corridor-bench' ";
  const Answer second = run_program(
      folder, "--version >/dev/null; " + holder + "run smoke --seeds 1 --out o --no-report");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_EQ(second.num_error_lines(), 1) << second.err;
  EXPECT_NE(second.err.find("/o: another run is writing to this folder; expected its end, or "
                            "another --out"),
            std::string::npos)
      << second.err;
  EXPECT_FALSE(fs::exists(folder / "o" / "results.sqlite"));
}

TEST(Report, LeavesAFolderToTheRunThatIsWritingToIt) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "o");
  const Answer answer =
      run_program(folder, "--version >/dev/null; flock o/.lock '" CORRIDOR_BINARY_DIR
                          "/bin/corridor-bench' "
                          "report o --out o");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_NE(answer.err.find("another run is writing to this folder"), std::string::npos)
      << answer.err;
}

TEST(Run, NotesThatADataSetWithoutTruthIsNotScored) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out mine.rawlog").exit_code, 0);
  fs::remove(folder / "mine.tum");
  fs::remove(folder / "mine.truth.toml");
  const Answer answer =
      run_program(folder, "run --system dead-reckoning --dataset mine.rawlog --out o --no-report");
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  const auto store = results::ResultsStore::open_read_only(folder / "o" / "results.sqlite");
  const results::RunResult result = store->read_all().value().front();
  EXPECT_EQ(result.status, results::CaseStatus::kOk);
  EXPECT_EQ(result.notes, std::vector<std::string>{"not scored: the data set has neither true "
                                                   "poses nor relations"});
}

TEST(Run, EndsWithOneIfACaseFails) {
  const ScratchFolder folder;
  folder.write("quick.toml",
               "name = \"quick\"\nsystems = [\"karto\"]\n"
               "scenarios = [\"paper-corridor\"]\nlimits.time_s = 0.05\n");
  const Answer answer = run_program(folder, "run quick.toml --out o");
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_NE(answer.out.find("timeout"), std::string::npos) << answer.out;
  EXPECT_TRUE(fs::exists(folder / "o" / "index.html"));
}

TEST(Run, TakesOnesOwnLogWithItsTruthBesideIt) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out mine.rawlog").exit_code, 0);
  const Answer answer =
      run_program(folder,
                  "run --system fusion-paper --system fusion-paper --dataset mine.rawlog "
                  "--dataset mine.rawlog --out o --no-report --quiet");
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_EQ(answer.out, "");
  const auto store = results::ResultsStore::open_read_only(folder / "o" / "results.sqlite");
  const results::RunResult result = store->read_all().value().front();
  EXPECT_EQ(result.dataset, "mine");
  EXPECT_FALSE(result.data_seed.has_value());
  EXPECT_TRUE(result.final_scores.position_rmse_m.has_value());
  EXPECT_TRUE(result.own_map.key_distances.has_value());
}

}  // namespace
}  // namespace corridor::testing
