// The command `solve`: what it answers, in which words, and what it refuses.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/bench/cli/program.hpp"

namespace corridor::testing {
namespace {

using Json = nlohmann::json;

// A triangle whose third edge does not quite fit.
constexpr const char* kTriangle =
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 2 1 1 0\n"
    "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 0 1 0 1 0 0 1 0 1\n"
    "EDGE_SE2 0 2 1.3 1 0 1 0 0 1 0 1\n";

TEST(Solve, AnswersWithTheKeysThatScriptsReadInBothModes) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  for (const std::string mode : {"batch", "incremental"}) {
    const Answer answer =
        run_program(folder, "solve t.g2o --backend gauss-newton --json --mode " + mode);
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    const Json json = Json::parse(answer.out);
    for (const char* key : {"graph", "backend", "linear", "mode", "init", "poses", "edges",
                            "status", "status_message", "iterations", "chi2", "chi2_initial",
                            "total_s", "cpu_s", "peak_rss_mib", "peak_growth_mib", "update_ms"}) {
      EXPECT_TRUE(json.contains(key)) << key;
    }
    EXPECT_EQ(json["graph"], "t.g2o");
    EXPECT_EQ(json["mode"], mode);
    EXPECT_EQ(json["linear"], "block");
    EXPECT_EQ(json["poses"], 3);
    EXPECT_EQ(json["edges"], 3);
    EXPECT_GT(json["cpu_s"], 0);
  }
}

TEST(Solve, FindsTheOptimumOfATriangleAndWritesIt) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  const Answer answer =
      run_program(folder, "solve t.g2o --backend levenberg --init odometry --out s.g2o --json");
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  const Json json = Json::parse(answer.out);
  EXPECT_EQ(json["status"], "converged");
  // 0.3 m are shared by three edges; turning does not help to first order.
  EXPECT_NEAR(json["chi2_initial"].get<double>(), 0.09, 1e-9);
  EXPECT_LT(json["chi2"].get<double>(), 0.0301);
  const Answer again = run_program(folder, "solve s.g2o --backend gauss-newton --json");
  EXPECT_NEAR(Json::parse(again.out)["chi2_initial"].get<double>(), json["chi2"].get<double>(),
              1e-9);
}

TEST(Solve, TellsTimesPerUpdateOnlyWhereThereAreUpdates) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  const std::string request = "solve t.g2o --backend gauss-newton --json";
  EXPECT_TRUE(Json::parse(run_program(folder, request).out)["update_ms"].is_null());
  const Json json = Json::parse(run_program(folder, request + " --mode incremental --every 2").out);
  for (const char* key : {"mean", "p50", "p95", "p99", "max"}) {
    EXPECT_GT(json["update_ms"][key], 0) << key;
  }
  EXPECT_EQ(json["every"], 2);
  EXPECT_TRUE(json["init"].is_null());
}

// A drive along a line that comes back to its start.
std::string out_and_back() {
  std::string text;
  for (int i = 0; i < 12; ++i) text += "VERTEX_SE2 " + std::to_string(i) + " 0 0 0\n";
  for (int i = 1; i < 12; ++i) {
    text += "EDGE_SE2 " + std::to_string(i - 1) + " " + std::to_string(i) + (i < 6 ? " 1" : " -1") +
            " 0 0 1 0 0 1 0 1\n";
  }
  return text + "EDGE_SE2 0 11 0.5 0 0 1 0 0 1 0 1\n";
}

TEST(Solve, SaysWhichEdgesAFixedLagLeftOut) {
  const ScratchFolder folder;
  folder.write("t.g2o", out_and_back());
  const std::string request = "solve t.g2o --backend fixed-lag --mode incremental --json --lag ";
  const Json narrow = Json::parse(run_program(folder, request + "5").out);
  EXPECT_EQ(narrow["dropped_edges"], 1);
  EXPECT_EQ(narrow["parameters"]["lag"], "5");
  const Json wide = Json::parse(run_program(folder, request + "12").out);
  EXPECT_EQ(wide["dropped_edges"], 0);
  EXPECT_LT(wide["chi2"], narrow["chi2"]);
}

TEST(Solve, RefusesNumbersThatAreNoneOrOutsideTheirRange) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  const std::string with = "solve t.g2o --backend isam2 ";
  for (const std::string value : {"nan", "-nan", "inf", "1", "-0.1", "half"}) {
    expect_refused(folder, with + "--false-closures " + value,
                   {"--false-closures", "expected a number from 0 to 0.95"});
    expect_refused(folder, with + "--robust dcs --inlier-probability " + value,
                   {"--inlier-probability", "expected a number from 0.5 to 0.999999"});
  }
  for (const std::string value : {"0", "-5", "1.5", "abc", "3000000000"}) {
    expect_refused(folder, with + "--mode incremental --every " + value,
                   {"--every", "expected a whole number from 1 to 1000000"});
  }
}

TEST(Solve, RefusesWhatNoEdgeDeterminesWithEveryBackEnd) {
  const ScratchFolder folder;
  folder.write("t.g2o", "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 0 0 1\n");
  for (const std::string back_end : {"gauss-newton", "levenberg", "isam2", "ceres"}) {
    for (const std::string mode : {"batch", "incremental"}) {
      expect_refused(folder, "solve t.g2o --backend " + back_end + " --mode " + mode,
                     {"pose 1 is undetermined", "1 edges with singular information"});
    }
  }
}

TEST(Solve, NamesTheNearestGraphOfTheCatalogue) {
  const ScratchFolder folder;
  expect_refused(folder, "solve m3500 --backend isam2", {"m3500", "nearest names: M3500"});
}

TEST(Solve, HasAllThatItWasAskedForInItsRecord) {
  const ScratchFolder folder;
  const Json json = Json::parse(run_program(folder,
                                            "solve walk-200-s1 --backend gauss-newton --json "
                                            "--false-closures 0.1 --false-pairs local --seed 7 "
                                            "--set gauss-newton.max_iterations=50")
                                    .out);
  EXPECT_EQ(json["false_share"], 0.1);
  EXPECT_EQ(json["false_pairs"], "local");
  EXPECT_EQ(json["seed"], "7");
  EXPECT_EQ(json["set"], Json({{"max_iterations", "50"}}));
  EXPECT_EQ(json["parameters"]["max_iterations"], "50");
  EXPECT_EQ(json["parameters"]["min_relative_decrease"], "1e-09");
}

TEST(Solve, AnUpdatePromisesNoConvergence) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  const std::string request = "solve t.g2o --backend gauss-newton --mode incremental --json";
  const Answer answer = run_program(folder, request);
  EXPECT_EQ(answer.exit_code, 0);
  EXPECT_EQ(Json::parse(answer.out)["status"], "updated");
  EXPECT_EQ(Json::parse(answer.out)["status_message"], "");
}

TEST(Solve, GoesOnUntilConvergedWhereAsked) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  const std::string request = "solve t.g2o --backend isam2 --mode incremental --json";
  const Json plain = Json::parse(run_program(folder, request).out);
  EXPECT_TRUE(plain["converge_s"].is_null());
  const Answer answer = run_program(folder, request + " --converge");
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  const Json json = Json::parse(answer.out);
  EXPECT_EQ(json["status"], "converged");
  EXPECT_GT(json["converge_rounds"], 0);
  EXPECT_LE(json["chi2"], plain["chi2"]);
}

TEST(Solve, TakesParametersOfItsBackEnd) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  const std::string with = "solve t.g2o --json --backend ";
  const Answer answer = run_program(folder, with +
                                                "gauss-newton --set gauss-newton.max_iterations=1 "
                                                "--set gauss-newton.linear=cholmod");
  EXPECT_EQ(answer.exit_code, 1) << answer.err;
  const Json json = Json::parse(answer.out);
  EXPECT_EQ(json["iterations"], 1);
  EXPECT_EQ(json["linear"], "cholmod");
  EXPECT_EQ(json["parameters"]["max_iterations"], "1");
  expect_refused(folder, with + "isam2 --set isam2.wildfir=1",
                 {"back-end isam2: unknown parameter wildfir (nearest: wildfire", "list backends"});
  expect_refused(folder, with + "isam2 --set isam2.wildfire=-1",
                 {"back-end isam2: wildfire = -1: expected >= 0"});
  expect_refused(folder, with + "isam2 --set ceres.max_iterations=1",
                 {"--set: back-end \"ceres\" is not used; expected isam2.key=value"});
  expect_refused(folder, with + "isam2 --set wildfire=1",
                 {"--set: \"wildfire=1\" cannot be read; expected NAME.key=value"});
  expect_refused(folder, with + "levenberg --linear block --set levenberg.linear=block",
                 {"--set: levenberg.linear is given twice"});
  expect_refused(folder, with + "levenberg --set levenberg.linear=qr",
                 {"linear = \"qr\": expected block or cholmod"});
}

TEST(Solve, RefusesWindowsAndConvergingWhereThereIsNone) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  expect_refused(folder, "solve t.g2o --backend fixed-lag",
                 {"--backend: a batch solution has no window"});
  expect_refused(folder, "solve t.g2o --backend isam2 --mode incremental --lag 3",
                 {"--lag: isam2 forgets no pose; expected --backend fixed-lag with it"});
  expect_refused(folder, "solve t.g2o --backend fixed-lag --mode incremental --lag 0",
                 {"--lag: '0' is no value for it; expected a whole number from 1"});
  expect_refused(folder, "solve t.g2o --backend isam2 --converge",
                 {"--converge: a batch solution goes on by itself"});
}

TEST(Solve, RefusesGraphsThatNobodyCanSolve) {
  const ScratchFolder folder;
  const std::string text = kTriangle;
  folder.write("parted.g2o", text + "VERTEX_SE2 7 0 0 0\n");
  folder.write("singular.g2o", text + "VERTEX_SE2 3 0 0 0\nEDGE_SE2 2 3 1 0 0 1 0 0 0 0 1\n");
  folder.write("nan.g2o", text + "EDGE_SE2 0 1 nan 0 0 1 0 0 1 0 1\n");
  folder.write("missing.g2o", text + "EDGE_SE2 0 9 1 0 0 1 0 0 1 0 1\n");
  folder.write("double.g2o", text + "VERTEX_SE2 1 0 0 0\n");
  const std::string with = " --backend gauss-newton";
  expect_refused(folder, "solve parted.g2o" + with,
                 {"parted.g2o: pose 7 cannot be reached from pose 0"});
  expect_refused(folder, "solve parted.g2o --mode incremental" + with,
                 {"parted.g2o: pose 7 cannot be reached from pose 0"});
  expect_refused(folder, "solve singular.g2o" + with,
                 {"singular.g2o: pose 3 is undetermined: 1 edges with singular information"});
  expect_refused(folder, "solve nan.g2o" + with, {"nan.g2o:7", "nan"});
  expect_refused(folder, "solve missing.g2o" + with, {"missing.g2o:7", "pose 9 has no vertex"});
  expect_refused(folder, "solve double.g2o" + with, {"double.g2o:7"});
}

TEST(Solve, RefusesRequestsThatMakeNoSense) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  const std::string with = "solve t.g2o --backend gauss-newton ";
  expect_refused(folder, "solve t.g2o", {"--backend"});
  expect_refused(folder, "solve t.g2o --backend magic",
                 {"--backend: unknown back-end \"magic\"; expected one of: ", "levenberg"});
  expect_refused(folder, "solve no.g2o --backend levenberg", {"no.g2o"});
  expect_refused(folder, with + "--init chordal --mode incremental", {"--init", "--mode batch"});
  expect_refused(folder, with + "--every 3", {"--every", "--mode incremental"});
  expect_refused(folder, with + "--width 2", {"--width", "--robust"});
  for (const std::string width : {"0", "-1", "nan", "inf", "2x"}) {
    expect_refused(
        folder, with + "--robust huber --width " + width,
        {"--width", "'" + width + "' is no value for it; expected a finite number above 0"});
  }
  expect_refused(folder, with + "--robust magic", {"--robust"});
  expect_refused(folder, with + "--robust gnc --mode incremental",
                 {"--robust", "gnc looks at all edges at once", "--mode batch"});
  expect_refused(folder, with + "--robust pcm --width 2", {"--width", "without a kernel"});
  expect_refused(folder, with + "--rejected r.csv", {"--rejected", "--robust with it"});
  expect_refused(folder, with + "--robust gnc --rejected t.g2o", {"t.g2o", "another name"});
  expect_refused(folder, with + "--robust gnc --rejected ./t.g2o", {"t.g2o", "another name"});
  expect_refused(folder, with + "--robust gnc --out s.g2o --rejected ./s.g2o",
                 {"s.g2o", "another name"});
  expect_refused(folder, with + "--robust gnc --inlier-probability 1", {"--inlier-probability"});
  expect_refused(folder, with + "--seed 3", {"--seed", "--false-closures with it"});
  expect_refused(folder, with + "--false-closures 1", {"--false-closures"});
  expect_refused(folder, with + "--linear qr", {"--linear"});
  expect_refused(folder, with + "--out s.txt", {"s.txt", ".g2o, .graph or .toro"});
  expect_refused(folder, with + "--out t.g2o", {"t.g2o", "the file that is read"});
}

TEST(Solve, RejectsAFalseClosureAndListsIt) {
  const ScratchFolder folder;
  // Poses 0 and 2 are no 9 m apart.
  folder.write("t.g2o", std::string(kTriangle) + "EDGE_SE2 0 2 9 1 0 1 0 0 1 0 1\n");
  for (const std::string method : {"gnc", "gnc-geman-mcclure", "pcm", "dcs"}) {
    const Answer answer =
        run_program(folder, "solve t.g2o --backend gauss-newton --json --robust " + method +
                                " --rejected r.csv");
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    const Json json = Json::parse(answer.out);
    EXPECT_EQ(json["rejected_edges"], 1) << method;
    EXPECT_EQ(json["inlier_probability"], 0.99);
    EXPECT_TRUE(json["rejection_recall"].is_null());
    const std::string list = text_of(folder / "r.csv");
    EXPECT_EQ(list.rfind("edge,pose_i,pose_j,chi2,planted\n3,0,2,", 0), 0u) << list;
  }
}

TEST(Solve, ScoresTheRejectionOfPlantedClosuresAndWritesThemWithTheGraph) {
  const ScratchFolder folder;
  folder.write("t.g2o", kTriangle);
  const std::string request = "solve t.g2o --backend gauss-newton --json --false-closures 0.5";
  const Answer answer = run_program(folder, request + " --robust gnc --seed 7 --out s.g2o");
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  const Json json = Json::parse(answer.out);
  EXPECT_EQ(json["false_closures"], 1);
  EXPECT_EQ(json["edges"], 4);
  EXPECT_TRUE(json.contains("rejection_precision"));
  EXPECT_FALSE(json["rejection_recall"].is_null());
  const Json again =
      Json::parse(run_program(folder, "solve s.g2o --backend gauss-newton --json").out);
  EXPECT_EQ(again["edges"], 4);
  EXPECT_TRUE(again["rejected_edges"].is_null());
}

TEST(Solve, AGraphWithoutASolutionIsAnAnswerThatNamesThePose) {
  const ScratchFolder folder;
  folder.write("t.g2o", std::string(kTriangle) +
                            "VERTEX_SE2 3 1 2 0\nEDGE_SE2 0 1 1 0 0 1e16 0 0 1e16 0 1e16\n"
                            "EDGE_SE2 2 3 0 1 0 1e-3 0 0 1e-3 0 1e-3\n");
  const Answer answer =
      run_program(folder, "solve t.g2o --backend gauss-newton --out s.g2o --json");
  EXPECT_EQ(answer.exit_code, 1) << answer.err;
  const Json json = Json::parse(answer.out);
  EXPECT_EQ(json["status"], "rank_deficient");
  EXPECT_EQ(json["status_message"], "pose 3 is undetermined");
  EXPECT_EQ(contents_of(folder.path()), std::vector<std::string>{"t.g2o"});
}

TEST(Solve, PlantsTheFalseClosuresThatRunPlantsForTheSameSeed) {
  const ScratchFolder folder;
  const Answer ran =
      run_program(folder,
                  "run --system graph-batch@gnc-false-30 --system graph-batch@none-false-30 "
                  "--backend gauss-newton --dataset walk-200-s1 --seed 1005 --seeds 1 --out o "
                  "--no-report");
  ASSERT_NE(ran.exit_code, 2) << ran.err;
  int num_records = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "o/runs")) {
    const Json record = Json::parse(text_of(entry.path() / "result.json"));
    const std::string robust = record["parameters"]["robust"];
    const Answer solved = run_program(folder,
                                      "solve walk-200-s1 --backend gauss-newton --init odometry "
                                      "--false-closures 0.3 --seed 1005 --json --robust " +
                                          robust);
    const Json json = Json::parse(solved.out);
    EXPECT_EQ(json["false_closures"], record["false_closures"]) << robust;
    EXPECT_EQ(json["chi2"], record["chi2"]) << robust;
    EXPECT_EQ(json["rejected_edges"], record["rejected_closures"]) << robust;
    EXPECT_EQ(json["rejection_precision"], record["rejection_precision"]) << robust;
    EXPECT_EQ(json["rejection_recall"], record["rejection_recall"]) << robust;
    ++num_records;
  }
  EXPECT_EQ(num_records, 2);
}

}  // namespace
}  // namespace corridor::testing
