#include "slam/core/params.hpp"

#include <gtest/gtest.h>

namespace corridor {
namespace {

struct ExampleParams {
  double range_m = 4.5;
  int num_beams = 360;
  unsigned num_threads = 1;
  bool use_odometry = true;
  std::string profile = "as-shipped";
  double offset_m = 0;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"range_m", "m", "how far", 0.1, 100}, p.range_m);
    v(ParamInfo{"num_beams", "1", "how many", 1, 4000}, p.num_beams);
    v(ParamInfo{"num_threads", "1", "how parallel", 1}, p.num_threads);
    v(ParamInfo{"use_odometry", "", "whether"}, p.use_odometry);
    v(ParamInfo{"profile", "", "which"}, p.profile);
    v(ParamInfo{"offset_m", "m", "anything finite"}, p.offset_m);
  }
  std::vector<std::string> relations() const {
    if (num_beams <= 100 * range_m) return {};
    return {"num_beams: expected at most 100 per metre of range_m"};
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string error_of(const ParamValues& overrides) {
  const auto params = with_overrides(ExampleParams{}, overrides, "suite.toml:7");
  return params ? "no error" : params.error().to_line();
}

TEST(Params, DefaultsAreValid) {
  EXPECT_EQ(param_violations(ExampleParams{}), std::vector<std::string>{});
}

TEST(Params, OverridesSetEveryType) {
  const auto params = with_overrides(ExampleParams{},
                                     {{"range_m", "6.25"},
                                      {"num_beams", "180"},
                                      {"num_threads", "2"},
                                      {"use_odometry", "false"},
                                      {"profile", "tuned"}},
                                     "test");
  ASSERT_TRUE(params) << params.error().to_line();
  EXPECT_EQ(params->range_m, 6.25);
  EXPECT_EQ(params->num_beams, 180);
  EXPECT_EQ(params->num_threads, 2u);
  EXPECT_FALSE(params->use_odometry);
  EXPECT_EQ(params->profile, "tuned");
}

TEST(Params, WithoutOverridesNothingChanges) {
  const auto params = with_overrides(ExampleParams{}, {}, "test");
  ASSERT_TRUE(params);
  EXPECT_EQ(param_values(*params), param_values(ExampleParams{}));
}

TEST(Params, DumpedValuesRestoreTheSameParameters) {
  ExampleParams params;
  params.range_m = 1.0 / 3;  // no short decimal
  params.num_beams = 7;
  params.use_odometry = false;
  params.offset_m = -1e-17;
  const auto again = with_overrides(ExampleParams{}, param_values(params), "test");
  ASSERT_TRUE(again) << again.error().to_line();
  EXPECT_EQ(again->range_m, params.range_m);
  EXPECT_EQ(again->offset_m, params.offset_m);
  EXPECT_EQ(param_values(*again), param_values(params));
}

TEST(Params, AllProblemsAreListedInOneError) {
  const std::string error = error_of({{"range_m", "0"},
                                      {"num_beams", "many"},
                                      {"use_odometry", "yes"},
                                      {"rnge_m", "3"},
                                      {"num_threads", "0"}});
  EXPECT_TRUE(contains(error, "suite.toml:7: ")) << error;
  EXPECT_TRUE(contains(error, "range_m = 0: expected 0.1 to 100")) << error;
  EXPECT_TRUE(contains(error, "num_beams = \"many\": expected integer")) << error;
  EXPECT_TRUE(contains(error, "use_odometry = \"yes\": expected true or false")) << error;
  EXPECT_TRUE(contains(error, "unknown parameter rnge_m (known: range_m num_beams")) << error;
  EXPECT_TRUE(contains(error, "num_threads = 0: expected >= 1")) << error;
}

TEST(Params, RelationsAcrossFieldsAreChecked) {
  EXPECT_TRUE(contains(error_of({{"range_m", "1"}}), "expected at most 100 per metre"));
}

TEST(Params, NumbersAreReadWholeOrNotAtAll) {
  for (const char* text : {"", " 5", "5 ", "5m", "0x10", "4,5", "1e", "+5"}) {
    EXPECT_TRUE(contains(error_of({{"range_m", text}}), "expected number")) << '"' << text << '"';
  }
  for (const char* text : {"5.0", "1e2", "", "99999999999"}) {
    EXPECT_TRUE(contains(error_of({{"num_beams", text}}), "expected integer")) << text;
  }
  EXPECT_TRUE(contains(error_of({{"num_threads", "-1"}}), "expected integer"));
}

TEST(Params, NumbersThatAreNotFiniteAreRefusedEvenWithoutARange) {
  for (const char* text : {"nan", "inf", "-inf"}) {
    EXPECT_TRUE(contains(error_of({{"offset_m", text}}), "offset_m")) << text;
    EXPECT_TRUE(contains(error_of({{"offset_m", text}}), "expected a finite number")) << text;
  }
}

TEST(Params, BoundsThemselvesAreAllowed) {
  EXPECT_EQ(error_of({{"range_m", "100"}}), "no error");
  EXPECT_EQ(error_of({{"range_m", "0.1"}, {"num_beams", "1"}}), "no error");
}

TEST(Params, TableStatesNameTypeDefaultUnitRangeAndMeaningInOrder) {
  const std::vector<ParamRow> rows = param_table<ExampleParams>();
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].name, "range_m");
  EXPECT_EQ(rows[0].type, "number");
  EXPECT_EQ(rows[0].value, "4.5");
  EXPECT_EQ(rows[0].unit, "m");
  EXPECT_EQ(rows[0].range, "0.1 to 100");
  EXPECT_EQ(rows[0].meaning, "how far");
  EXPECT_EQ(rows[1].type, "integer");
  EXPECT_EQ(rows[2].range, ">= 1");
  EXPECT_EQ(rows[3].type, "true or false");
  EXPECT_EQ(rows[3].value, "true");
  EXPECT_EQ(rows[4].type, "text");
  EXPECT_EQ(rows[5].range, "");
}

}  // namespace
}  // namespace corridor
