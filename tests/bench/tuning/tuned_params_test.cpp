// The frozen parameters of the profiles `tuned` against the rule that drew them.
#include "bench/tuning/tuned_params.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "bench/runner/systems.hpp"
#include "datasets/catalog/sha256.hpp"
#include "tests/support/documents.hpp"

namespace corridor::tuning {
namespace {

struct Dimension {
  std::string system, parameter, kind;
  std::vector<std::string> values;
};

std::vector<Dimension> read_space() {
  std::vector<Dimension> space;
  std::istringstream lines(testing::text_of_document("bench/tuning/space.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    Dimension dimension;
    fields >> dimension.system >> dimension.parameter >> dimension.kind;
    for (std::string value; fields >> value;) dimension.values.push_back(value);
    space.push_back(dimension);
  }
  return space;
}

// As bench/tune.sh draws: the first 48 bits of a hash as a share of one.
std::string drawn(const Dimension& dimension, int candidate) {
  const std::string hash = catalog::to_hex(catalog::sha256_of(
      fmt::format("{}/{}/{}", dimension.system, candidate, dimension.parameter)));
  const double u =
      static_cast<double>(std::stoull(hash.substr(0, 12), nullptr, 16)) / std::pow(16.0, 12);
  if (dimension.kind == "choice") {
    return dimension
        .values[static_cast<std::size_t>(u * static_cast<double>(dimension.values.size()))];
  }
  const double low = std::stod(dimension.values.at(0));
  const double high = std::stod(dimension.values.at(1));
  if (dimension.kind == "linear") return fmt::format("{:.4g}", low + u * (high - low));
  const double value = low * std::exp(u * std::log(high / low));
  return dimension.kind == "count" ? fmt::format("{}", static_cast<int>(value + 0.5))
                                   : fmt::format("{:.4g}", value);
}

TEST(TunedParams, AreTheDrawsOfTheirCandidate) {
  for (const TunedParams& tuned : all_tuned_params()) {
    ParamValues expected;
    for (const Dimension& dimension : read_space()) {
      if (dimension.system != tuned.system || tuned.candidate == 0) continue;
      expected[dimension.parameter] = drawn(dimension, tuned.candidate);
    }
    EXPECT_EQ(tuned.overrides, expected) << tuned.system;
  }
}

TEST(TunedParams, WereSearchedWithOneBudgetAndOneHashForEverySystemOfTheSpace) {
  std::set<std::string> searched;
  for (const Dimension& dimension : read_space()) searched.insert(dimension.system);
  std::set<std::string> frozen;
  for (const TunedParams& tuned : all_tuned_params()) {
    const TunedParams& first = all_tuned_params().front();
    frozen.insert(tuned.system);
    EXPECT_EQ(tuned.search_sha256, first.search_sha256);
    EXPECT_EQ(tuned.num_candidates, first.num_candidates);
    EXPECT_EQ(tuned.num_worlds, first.num_worlds);
    EXPECT_EQ(tuned.search_sha256.size(), 64u);
    EXPECT_LT(tuned.candidate, tuned.num_candidates);
    EXPECT_LE(tuned.score_m, tuned.default_score_m) << "the default is candidate 0";
  }
  EXPECT_EQ(frozen, searched);
}

TEST(TunedParams, AreProfilesOfTheirSystems) {
  for (const TunedParams& tuned : all_tuned_params()) {
    const runner::SystemInfo info = *runner::find_system(tuned.system);
    ASSERT_TRUE(info.has_profile("tuned")) << tuned.system;
    const ParamValues values = *info.resolve("tuned", {});
    for (const auto& [name, text] : tuned.overrides) {
      EXPECT_EQ(values.at(name), info.resolve("tuned", {{name, text}})->at(name)) << name;
    }
  }
}

}  // namespace
}  // namespace corridor::tuning
