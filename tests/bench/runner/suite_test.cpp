#include "bench/runner/suite.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bench/runner/overrides.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::runner {
namespace {

constexpr const char* kGood = R"(name = "mine"
systems = ["karto@corrected", "gmapping"]
scenarios = ["paper-corridor"]
num_seeds = 3
first_seed = 7
[limits]
time_s = 1.5
memory_mib = 100
[overrides.karto]
buffer_size_scans = 20
use_loop_closing = false
)";

Result<Suite> parse(const std::string& text) {
  const testing::ScratchFolder folder;
  return read_suite(folder.write("mine.toml", text));
}

// The Error's line, from the file's name on; "accepted" if there is none.
std::string refusal(const std::string& text) {
  const Result<Suite> suite = parse(text);
  if (suite) return "accepted";
  const std::string line = suite.error().to_line();
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 0) << line;
  return line.substr(line.find("mine.toml"));
}

// kGood with one line replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = kGood;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

#define EXPECT_REFUSED(text, part) \
  EXPECT_NE(refusal(text).find(part), std::string::npos) << refusal(text)

TEST(Suite, KeepsEverythingTheFileSays) {
  const Result<Suite> suite = parse(kGood);
  ASSERT_TRUE(suite.has_value()) << suite.error().to_line();
  EXPECT_EQ(suite->systems,
            (std::vector<SystemChoice>{{"karto", "corrected"}, {"gmapping", "as-shipped"}}));
  EXPECT_EQ(suite->num_seeds, 3);
  EXPECT_EQ(suite->first_seed, 7U);
  EXPECT_EQ(suite->limits, (CaseLimits{1.5, 100}));
  EXPECT_EQ(suite->overrides.at("karto"),
            (ParamValues{{"buffer_size_scans", "20"}, {"use_loop_closing", "false"}}));
}

TEST(Suite, GivesASystemBackEndsOfItsOwn) {
  const Result<Suite> suite = parse(
      std::string(kGood) + "[backends_of]\n\"karto@corrected\" = " + "[\"ceres\", \"isam2\"]\n");
  ASSERT_TRUE(suite.has_value()) << suite.error().to_line();
  EXPECT_EQ(suite->backends_for({"karto", "corrected"}),
            (std::vector<std::string>{"ceres", "isam2"}));
  EXPECT_TRUE(suite->backends_for({"karto", "as-shipped"}).empty());
}

TEST(Suite, RefusesBackEndsOfWhatIsNotRunOrTakesNone) {
  const std::string table = std::string(kGood) + "[backends_of]\n";
  EXPECT_REFUSED(table + "karto = [\"ceres\"]\n", "the suite does not run karto@as-shipped");
  EXPECT_REFUSED(table + "gmapping = [\"ceres\"]\n", "gmapping takes no back-end");
  EXPECT_REFUSED(table + "\"karto@corrected\" = [\"magic\"]\n", "unknown back-end \"magic\"");
  EXPECT_REFUSED(table + "kartoo = [\"ceres\"]\n", "unknown system \"kartoo\"");
}

TEST(Suite, RefusesAnUnknownKeyWithItsLine) {
  EXPECT_REFUSED(with("num_seeds = 3", "num_seed = 3"), "mine.toml:4: unknown key \"num_seed\"");
}

TEST(Suite, RefusesAnUnknownSystemAndNamesTheKnownOnes) {
  EXPECT_REFUSED(with("\"gmapping\"", "\"gmaping\""),
                 "mine.toml:2: unknown system \"gmaping\"; expected one of: ");
}

TEST(Suite, RefusesAnUnknownProfile) {
  EXPECT_REFUSED(with("@corrected", "@broken"), "unknown profile \"broken\" of system karto");
}

TEST(Suite, RefusesAnUnknownBackEnd) {
  EXPECT_REFUSED(with("num_seeds = 3", "backends = [\"magic\"]"), "unknown back-end \"magic\"");
}

TEST(Suite, RefusesWrongTypes) {
  EXPECT_REFUSED(with("\"mine\"", "3"), "mine.toml:1: name: expected a text");
  EXPECT_REFUSED(with("[\"paper-corridor\"]", "\"paper-corridor\""), "expected an array of texts");
  EXPECT_REFUSED(with("num_seeds = 3", "num_seeds = 2.5"), "num_seeds: expected an integer");
  EXPECT_REFUSED(with("num_seeds = 3", "num_seeds = 0"), "num_seeds: expected an integer from 1");
}

TEST(Suite, RefusesLimitsThatAreNone) {
  EXPECT_REFUSED(with("time_s = 1.5", "time_s = -1"), "limits.time_s: expected a number > 0");
  EXPECT_REFUSED(with("memory_mib = 100", "memory_mb = 100"), "unknown key \"limits.memory_mb\"");
}

TEST(Suite, RefusesOverridesThatTheSystemRefuses) {
  EXPECT_REFUSED(with("buffer_size_scans = 20", "buffer_size = 20"),
                 "unknown parameter buffer_size (nearest: buffer_size_scans, ");
  EXPECT_REFUSED(with("buffer_size_scans = 20", "buffer_size_scans = 0"),
                 "buffer_size_scans = 0: expected 1 to");
  EXPECT_REFUSED(with("buffer_size_scans = 20", "buffer_size_scans = [1]"),
                 "expected a number, text or truth value");
}

TEST(Suite, RefusesOverridesOfASystemThatIsNotRun) {
  EXPECT_REFUSED(with("overrides.karto", "overrides.fusion"),
                 "overrides.fusion: the suite does not run this system");
}

TEST(Suite, RefusesASystemGivenTwice) {
  EXPECT_REFUSED(with("\"gmapping\"", "\"karto@corrected\""), "is given twice");
}

TEST(Suite, RefusesASuiteWithoutNameSystemsOrData) {
  EXPECT_REFUSED(with("name = \"mine\"", ""), "key \"name\" is missing");
  EXPECT_REFUSED(with("[\"karto@corrected\", \"gmapping\"]", "[]"),
                 "\"systems\" is missing or empty");
  EXPECT_REFUSED(with("scenarios = [\"paper-corridor\"]", ""), "names any data");
}

TEST(Suite, RefusesBrokenSyntaxWithItsLine) {
  EXPECT_REFUSED(with("num_seeds = 3", "num_seeds = "), "mine.toml:4:");
}

TEST(Suite, ListsAllViolationsAtOnce) {
  const std::string line = refusal("name = 1\nfoo = 2\nsystems = [\"x\"]\n");
  for (const char* part :
       {":1: name", ":2: unknown key \"foo\"", ":3: unknown system \"x\"", "data"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
}

TEST(Suites, OfTheTreeAreAllReadAndNamedAsTheirFiles) {
  ASSERT_FALSE(list_suites().empty());
  for (const std::filesystem::path& path : list_suites()) {
    const Result<Suite> suite = read_suite(path);
    ASSERT_TRUE(suite.has_value()) << suite.error().to_line();
    EXPECT_EQ(suite->name, path.stem());
    EXPECT_FALSE(suite->description.empty());
  }
}

TEST(Suites, OfTheTreeSimulateNoSeedThatIsForDevelopment) {
  for (const std::filesystem::path& path : list_suites()) {
    const Result<Suite> suite = read_suite(path);
    ASSERT_TRUE(suite.has_value()) << suite.error().to_line();
    EXPECT_TRUE(suite->scenarios.empty() || suite->first_seed > 1000) << path;
  }
}

TEST(Suites, AreFoundByNameAndByPathAndTheKnownOnesAreNamed) {
  EXPECT_TRUE(find_suite("smoke").has_value());
  EXPECT_NE(find_suite("smoky").error().to_line().find("smoke"), std::string::npos);
  EXPECT_EQ(find_suite("no/such.toml").error().code, ErrorCode::kNotFound);
}

TEST(Overrides, UnknownNamesAndBrokenRulesAreListedTogetherInAShortLine) {
  const auto refused = resolve_overrides(*find_system("karto"), "as-shipped",
                                         {{"bufer_size_scans", "5"}, {"buffer_size_scans", "0"}});
  ASSERT_FALSE(refused.has_value());
  const std::string line = refused.error().to_line();
  for (const char* part : {"unknown parameter bufer_size_scans (nearest: buffer_size_scans, ",
                           "buffer_size_scans = 0: expected", "list profiles --json"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
  EXPECT_LT(line.size(), 300U) << line;
}

TEST(Overrides, OfTheCommandLineAreCheckedAgainstTheSystem) {
  Suite suite = *parse(kGood);
  EXPECT_TRUE(add_overrides(suite, {"gmapping.num_particles=10", "karto.map_min_passes=3"}));
  EXPECT_EQ(suite.overrides.at("gmapping").at("num_particles"), "10");
  EXPECT_EQ(suite.overrides.at("karto").at("buffer_size_scans"), "20");
  EXPECT_FALSE(add_overrides(suite, {"gmapping.num_particles"}));
  EXPECT_FALSE(add_overrides(suite, {"num_particles=10"}));
  EXPECT_FALSE(add_overrides(suite, {"nobody.num_particles=10"}));
  Suite fresh = *parse(kGood);
  EXPECT_FALSE(add_overrides(fresh, {"gmapping.num_particles=0"}));
}

TEST(Overrides, OfABackEndReachTheCasesThatHaveItAndNoOthers) {
  Suite suite = *parse(kGood);
  ASSERT_TRUE(add_overrides(suite, {"isam2.wildfire=0.2"}));
  const ParamValues with = overrides_of_case(suite, "karto", "isam2");
  EXPECT_EQ(with.at("isam2.wildfire"), "0.2");
  EXPECT_FALSE(overrides_of_case(suite, "karto", "ceres").contains("isam2.wildfire"));
  const CaseOverrides parts = split_overrides(with, "isam2");
  EXPECT_EQ(parts.back_end, (ParamValues{{"wildfire", "0.2"}}));
  EXPECT_EQ(parts.system, suite.overrides.at("karto"));
  EXPECT_FALSE(add_overrides(suite, {"isam2.wildfire=-1"}));
}

}  // namespace
}  // namespace corridor::runner
