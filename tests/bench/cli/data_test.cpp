// The commands about data: fetching from a server of the test's own, and looking at logs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/catalog/sha256.hpp"
#include "tests/bench/cli/program.hpp"
#include "tests/support/http_server.hpp"

namespace corridor::testing {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLog =
    "FLASER 4 1 1 1 1 0 0 0 0 0 0 1.0 host 1.0\n"
    "FLASER 4 1 1 1 90 0.1 0 0 0.1 0 0 1.1 host 1.1\n";

// A catalogue with one log on the server, one nowhere, and the program's surroundings set to it.
class DataCommand : public ::testing::Test {
 protected:
  DataCommand() {
    fs::create_directory(folder_ / "data");
    folder_.write("catalog.toml",
                  entry("here", kLog, "url = \"" + server_.url("/a.clf") + "\"", "") +
                      entry("made", "x", "", "not_fetchable = \"made here\"\n"));
  }

  static std::string entry(const std::string& name, const std::string& content,
                           const std::string& url, const std::string& more) {
    return "[[dataset]]\nname = \"" + name + "\"\ntitle = \"A log\"\nformat = \"carmen\"\n" +
           "files = [{ path = \"sub/" + name + ".clf\", sha256 = \"" +
           catalog::to_hex(catalog::sha256_of(content)) + "\"" + (url.empty() ? "" : ", " + url) +
           " }]\ntruth = \"none\"\norder = \"stamp\"\nlicence = \"none stated\"\n"
           "source = \"a test\"\n" +
           more;
  }

  [[nodiscard]] Answer run(const std::string& arguments) const {
    return run_program(folder_, arguments,
                       "unset CORRIDOR_BENCH_DATA; export CORRIDOR_BENCH_CATALOG='" +
                           (folder_ / "catalog.toml").string() + "' XDG_CACHE_HOME='" +
                           (folder_ / "cache").string() + "'; ");
  }

  ScratchFolder folder_;
  std::string served_ = kLog;
  HttpServer server_{
      [this](const HttpRequest& request) { return HttpServer::serve_content(request, served_); }};
};

TEST_F(DataCommand, FetchBringsADatasetThatIsThenFoundAndVerified) {
  EXPECT_EQ(run("data verify here --data-dir data").exit_code, 1);
  const Answer fetched = run("data fetch here --data-dir data");
  EXPECT_EQ(fetched.exit_code, 0) << fetched.err << fetched.out;
  EXPECT_NE(fetched.out.find("fetched"), std::string::npos) << fetched.out;
  EXPECT_EQ(fetched.out.find('\r'), std::string::npos) << "no progress where nobody looks";
  EXPECT_EQ(text_of(folder_ / "data/sub/here.clf"), kLog);
  EXPECT_EQ(run("data verify here --data-dir data").exit_code, 0);
  const Answer again = run("data fetch here --data-dir data");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.out.find("is here"), std::string::npos) << again.out;
  EXPECT_EQ(server_.requests().size(), 1U);
}

TEST_F(DataCommand, FetchTakesTheCacheFolderIfNoneIsNamed) {
  EXPECT_EQ(run("data fetch here").exit_code, 0);
  EXPECT_EQ(text_of(folder_ / "cache/corridor-bench/sub/here.clf"), kLog);
  EXPECT_EQ(run("data verify here").exit_code, 0);
}

TEST_F(DataCommand, FetchOfEverythingLeavesOutWhatNobodyPublishesAndSaysWhy) {
  const Answer all = run("data fetch --data-dir data");
  EXPECT_EQ(all.exit_code, 0) << all.err << all.out;
  EXPECT_NE(all.out.find("made here"), std::string::npos) << all.out;
  EXPECT_EQ(run("data fetch made --data-dir data").exit_code, 1) << "it was asked for by name";
}

TEST_F(DataCommand, FetchEndsWithOneIfWhatComesIsSomethingElse) {
  served_ = "forged";
  const Answer answer = run("data fetch here --data-dir data");
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_NE(answer.out.find("SHA-256 is"), std::string::npos) << answer.out;
  EXPECT_EQ(contents_of(folder_ / "data"), std::vector<std::string>{"sub"});
}

TEST_F(DataCommand, AnUnknownNameIsABadRequestAnsweredWithTheNearest) {
  for (const std::string command : {"fetch", "verify"}) {
    const Answer answer = run("data " + command + " nowhere --data-dir data");
    EXPECT_EQ(answer.exit_code, 2);
    EXPECT_EQ(answer.num_error_lines(), 1) << answer.err;
    EXPECT_NE(answer.err.find("no data set 'nowhere' in the catalogue; expected a name of `data "
                              "list`; the nearest: here"),
              std::string::npos)
        << answer.err;
  }
  EXPECT_TRUE(server_.requests().empty());
}

TEST_F(DataCommand, InspectOfADatasetByNameSaysThatItIsFit) {
  folder_.write("data/sub/here.clf", kLog);
  const Answer text = run("data inspect here --data-dir data");
  EXPECT_EQ(text.exit_code, 0) << text.err << text.out;
  EXPECT_NE(text.out.find("here (carmen, "), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("\nfit, 0 suspicions\n"), std::string::npos) << text.out;
  const Answer json = run("data inspect here --json --data-dir data");
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report.at("is_fit"), true);
  EXPECT_EQ(report.at("lidar").at("num_readings"), 2);
  EXPECT_NEAR(report.at("lidar").at("median_rate_hz").get<double>(), 10, 1e-6);
  EXPECT_NEAR(report.at("lidar").at("invalid_ratio").get<double>(), 0.125, 1e-12);
  EXPECT_NEAR(report.at("wheels").at("path_m").get<double>(), 0.1, 1e-12);
  EXPECT_TRUE(report.at("imu").is_null());
  EXPECT_TRUE(report.at("truth").is_null());
  EXPECT_TRUE(report.at("robot_model").at("lidar").contains("range_max_m"));
}

TEST_F(DataCommand, InspectOfADatasetWithOtherBytesSaysThatItIsRefusedByThisName) {
  folder_.write("data/sub/here.clf", std::string(kLog) + "# another version\n");
  const Answer answer = run("data inspect here --data-dir data");
  EXPECT_EQ(answer.exit_code, 1) << answer.err;
  EXPECT_NE(
      answer.out.find("is not the catalogue's: refused as data set here\nnot fit, 1 defect\n"),
      std::string::npos)
      << answer.out;
  EXPECT_EQ(answer.out.find("on request"), std::string::npos) << answer.out;
  EXPECT_NE(answer.out.find("LiDAR: 4 beams"), std::string::npos) << answer.out;
}

TEST_F(DataCommand, ListSaysThatItComparesNoChecksums) {
  folder_.write("data/sub/here.clf", "something else");
  const Answer text = run("data list --data-dir data");
  EXPECT_NE(
      text.out.find("\nis_found: files of those names are there; data verify compares checksums\n"),
      std::string::npos)
      << text.out;
  const auto rows = nlohmann::json::parse(run("data list --json --data-dir data").out);
  EXPECT_EQ(rows.at(0).at("is_found"), true);
}

TEST_F(DataCommand, ListNamesWhatIsMissingBesideALogThatIsThere) {
  const std::string whole = "data list --data-dir data";
  EXPECT_EQ(run(whole).out.find("missing_files"), std::string::npos);
  std::string own = entry("own", kLog, "", "not_fetchable = \"made here\"\n");
  own.insert(own.find(" }]") + 2,
             ", { path = \"sub/own.robot.toml\", sha256 = \"" + std::string(64, '0') + "\" }");
  folder_.write("data/catalog.toml", own);
  folder_.write("data/sub/own.clf", kLog);
  EXPECT_NE(run(whole).out.find("sub/own.robot.toml"), std::string::npos) << run(whole).out;
  const auto row = nlohmann::json::parse(run(whole + " --json").out).back();
  EXPECT_EQ(row.at("is_found"), false);
  EXPECT_EQ(row.at("missing_files"), nlohmann::json({"sub/own.robot.toml"}));
  EXPECT_EQ(row.at("path"), (folder_ / "data/sub/own.clf").string()) << row;
}

TEST_F(DataCommand, InspectListsTheDefectsOfALogThatNothingElseTakes) {
  folder_.write("bad.clf", std::string(kLog) + "FLASER 3 1 1 1 0.1 0 0 0.1 0 0 0.5 host 0.5\n");
  const Answer text = run("data inspect bad.clf");
  EXPECT_EQ(text.exit_code, 1) << text.err;
  EXPECT_NE(text.out.find("defect: line 3, event 4: stamp steps back"), std::string::npos)
      << text.out;
  EXPECT_NE(text.out.find("scan of 3 beams"), std::string::npos) << text.out;
  const Answer json = run("data inspect bad.clf --json");
  EXPECT_EQ(json.exit_code, 1);
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report.at("is_fit"), false);
  EXPECT_EQ(report.at("lidar").at("num_stamps_back"), 1);
  EXPECT_EQ(report.at("lidar").at("first_bad_stamp_at"), "line 3");
}

TEST_F(DataCommand, InspectCallsNoLogFitThatRunRefusesForWhatLiesBesideIt) {
  const std::vector<std::pair<std::string, std::string>> companions = {
      {"a.tum", "garbage\n"},
      {"a.tum", "1000 0 0 0 0 0 0 1\n1100 0.1 0 0 0 0 0 1\n"},
      {"a.tum", "2000 0 0 0 0 0 0 1\n"},
      {"a.relations", "garbage\n"},
      {"a.relations", "2000 2001 0 0 0 0 0 0\n"},
      {"a.truth.toml", "[world\n"}};
  for (const auto& [name, text] : companions) {
    folder_.write("a.clf", kLog);
    folder_.write(name, text);
    EXPECT_EQ(run("run --system dead-reckoning --dataset a.clf --out o").exit_code, 2) << text;
    const Answer answer = run("data inspect a.clf");
    EXPECT_EQ(answer.exit_code, 1) << answer.out;
    EXPECT_NE(answer.out.find("\ndefect: " + name + ":"), std::string::npos) << answer.out;
    EXPECT_EQ(answer.out.find("kept although refused"), std::string::npos) << answer.out;
    fs::remove(folder_ / name);
  }
}

TEST_F(DataCommand, ALogWithoutAReturnIsNotFitAndRunSaysSo) {
  folder_.write("a.clf",
                "FLASER 4 100 100 100 190 0 0 0 0 0 0 1.0 host 1.0\n"
                "FLASER 4 100 100 100 190 0.1 0 0 0.1 0 0 1.1 host 1.1\n");
  const Answer inspected = run("data inspect a.clf");
  EXPECT_EQ(inspected.exit_code, 1);
  EXPECT_NE(inspected.out.find("\ndefect: no beam of any scan has a return; expected at least "
                               "one\nnot fit, 1 defect\n"),
            std::string::npos)
      << inspected.out;
  const Answer ran = run("run --system dead-reckoning --dataset a.clf --out o --no-report");
  EXPECT_NE(ran.out.find("note: suspicious data: LiDAR: no beam of any scan has a return"),
            std::string::npos)
      << ran.out << ran.err;
}

TEST_F(DataCommand, InspectOfWhatIsNoLogIsABadRequest) {
  folder_.write("garbage.clf", "no log at all\n");
  for (const std::string what : {"garbage.clf", "nowhere.clf", "data", "made"}) {
    const Answer answer = run("data inspect " + what);
    EXPECT_EQ(answer.exit_code, 2) << what;
    EXPECT_EQ(answer.num_error_lines(), 1) << answer.err;
    EXPECT_EQ(answer.out, "") << what;
  }
}

TEST_F(DataCommand, ADataFolderBringsItsOwnCatalogueAndAnotherFolderDoesNotSeeIt) {
  folder_.write("mine/sub/own.clf", kLog);
  folder_.write("mine/catalog.toml", entry("own", kLog, "", "not_fetchable = \"made here\"\n"));
  const Answer list = run("data list --data-dir mine");
  EXPECT_EQ(list.exit_code, 0) << list.err;
  EXPECT_NE(list.out.find("/mine/catalog.toml"), std::string::npos) << list.out;
  EXPECT_NE(list.out.find("built in"), std::string::npos) << list.out;
  EXPECT_EQ(run("data verify own --data-dir mine").exit_code, 0);
  EXPECT_EQ(run("data verify own --data-dir data").exit_code, 2);
  const Answer answer =
      run("run --system dead-reckoning --dataset own --data-dir mine --out o --no-report");
  EXPECT_EQ(answer.exit_code, 0) << answer.err << answer.out;
}

TEST_F(DataCommand, ACatalogueOfADataFolderThatIsBrokenIsOneLine) {
  folder_.write("mine/catalog.toml", "junk\n");
  for (const std::string command :
       {"data list", "data verify", "data inspect x.clf", "convert x.clf y.clf",
        "run --system dead-reckoning --dataset here --out o", "run smoke --out o"}) {
    const Answer answer = run(command + " --data-dir mine");
    EXPECT_EQ(answer.exit_code, 2) << command;
    EXPECT_EQ(answer.num_error_lines(), 1) << answer.err;
    EXPECT_NE(answer.err.find("/mine/catalog.toml:1: "), std::string::npos) << answer.err;
  }
}

TEST_F(DataCommand, ANameThatIsAScenarioAndADataSetIsRefused) {
  folder_.write("mine/catalog.toml",
                entry("rectangle", kLog, "", "not_fetchable = \"made here\"\n"));
  const std::string clash = "catalog.toml:1: 'rectangle' is a scenario and a data set";
  const Answer list = run("data list --data-dir mine");
  EXPECT_NE(list.out.find("\nrefused by that name: "), std::string::npos) << list.out;
  EXPECT_NE(list.out.find(clash), std::string::npos) << list.out;
  folder_.write("mine.toml",
                "name = \"mine\"\nsystems = [\"dead-reckoning\"]\nscenarios = [\"rectangle\"]\n");
  for (const std::string command :
       {"run --system dead-reckoning --dataset rectangle --out o", "run mine.toml --out o"}) {
    const Answer answer = run(command + " --data-dir mine");
    EXPECT_EQ(answer.exit_code, 2) << command;
    EXPECT_NE(answer.err.find(clash), std::string::npos) << answer.err;
  }
}

TEST_F(DataCommand, ConvertTakesOtherBytesUnderAKnownNameOnlyIfAskedTo) {
  folder_.write("data/sub/here.clf", std::string(kLog) + "# another version\n");
  EXPECT_EQ(run("convert here own.clf --data-dir data").exit_code, 2);
  const Answer asked = run("convert here own.clf --accept-other-checksum --data-dir data");
  EXPECT_EQ(asked.exit_code, 0) << asked.err;
  EXPECT_NE(asked.out.find("accepted on request"), std::string::npos) << asked.out;
  EXPECT_TRUE(fs::exists(folder_ / "own.clf"));
}

TEST(RunOnALog, WhoseTruthIsInCentimetresSaysSoBesideTheStatus) {
  const ScratchFolder folder;
  std::string log, truth;
  for (int i = 0; i <= 40; ++i) {
    log += fmt::format("FLASER 4 1 1 1 {0} {1} 0 0 {1} 0 0 {2} host {2}\n", 2 + 0.01 * i, 0.05 * i,
                       1 + 0.1 * i);
    truth += fmt::format("{} {} 0 0 0 0 0 1\n", 1 + 0.1 * i, 5 * i);
  }
  folder.write("a.clf", log);
  folder.write("a.tum", truth);
  const Answer answer =
      run_program(folder, "run --system dead-reckoning --dataset a.clf --out o --no-report");
  EXPECT_NE(answer.out.find("note: suspicious data: truth: a path 100 times as long as that of the "
                            "wheels (200.000 m, 2.000 m)"),
            std::string::npos)
      << answer.out << answer.err;
}

TEST(Inspect, OfASimulatedLogKnowsItsTruthAndFindsTheGyroInAgreement) {
  const ScratchFolder folder;
  ASSERT_EQ(run_program(folder, "simulate paper-corridor --out a.rawlog --quiet").exit_code, 0);
  const Answer answer = run_program(folder, "data inspect a.rawlog --json");
  ASSERT_EQ(answer.exit_code, 0) << answer.err << answer.out;
  const auto report = nlohmann::json::parse(answer.out);
  EXPECT_EQ(report.at("suspicions").size(), 0U) << report.at("suspicions").dump();
  EXPECT_EQ(report.at("truth").at("scans_with_pose_ratio"), 1.0);
  EXPECT_NEAR(report.at("truth").at("path_m").get<double>(),
              report.at("wheels").at("path_m").get<double>(),
              0.1 * report.at("truth").at("path_m").get<double>());
}

}  // namespace
}  // namespace corridor::testing
