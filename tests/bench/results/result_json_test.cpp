#include "bench/results/result_json.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "bench/results/result_keys.hpp"
#include "tests/bench/results/random_result.hpp"

namespace corridor::results {
namespace {

RC_GTEST_PROP(ResultJson, ReadingWhatWasWrittenGivesTheSameText, ()) {
  const RunResult result = draw_result();
  const std::string text = to_json(result);
  const Result<RunResult> again = result_from_json(text, "test");
  RC_ASSERT(again.has_value());
  // The text shows every field with all its digits, so equal texts are equal records.
  RC_ASSERT(to_json(*again) == text);
}

TEST(ResultJson, HoldsExactlyTheKeysOfTheContract) {
  // Written down by hand from the contract, so that a renamed key fails here.
  std::istringstream contract(
      "system profile backend dataset data_seed system_seed threads parameters_hash git_revision "
      "machine_id status status_message poses_expected poses_matched association alignment "
      "position_rmse_m angle_rmse_deg ate_se2_rmse_m ate_se2_angle_rmse_deg rpe_1m_rmse_m "
      "rpe_1m_angle_rmse_deg online_position_rmse_m online_angle_rmse_deg online_ate_se2_rmse_m "
      "online_ate_se2_angle_rmse_deg online_rpe_1m_rmse_m online_rpe_1m_angle_rmse_deg "
      "relations_used relations_skipped relations_translation_mean_m relations_translation_std_m "
      "relations_rotation_mean_deg relations_rotation_std_deg key_distances map_chamfer_m "
      "map_hausdorff95_m rendered_key_distances rendered_map_chamfer_m rendered_map_hausdorff95_m "
      "bound_position_rmse_m bound_angle_rmse_deg nees_mean nees_last nees_dof chi2 factors "
      "variables relinearised slip_precision slip_recall "
      "slip_latency_s degeneracy_precision degeneracy_recall stages step_p50_us step_p95_us "
      "step_p99_us step_max_us wall_s cpu_s peak_rss_mib realtime_factor "
      // of pose graphs
      "data_kind iterations eliminated factor_nonzeros chi2_initial chi2_best chi2_best_source "
      "chi2_gap_ratio "
      "run_gap_p50_ratio run_gap_max_ratio run_newest_gap_max_m step_mean_us init_s "
      "false_closures rejected_closures rejection_precision rejection_recall peak_growth_mib "
      // beyond the contract's table
      "case_id suite data_source data_digest true_poses jobs notes parameters overrides build_id "
      "counters "
      "online_relations_used "
      "online_relations_skipped "
      "online_relations_translation_mean_m online_relations_translation_std_m "
      "online_relations_rotation_mean_deg online_relations_rotation_std_deg");
  std::set<std::string> expected;
  for (std::string key; contract >> key;) expected.insert(key);
  std::set<std::string> written;
  const auto json = nlohmann::json::parse(to_json(RunResult{}));
  for (const auto& item : json.items()) written.insert(item.key());
  EXPECT_EQ(written, expected);
}

TEST(ResultJson, WritesNullWhereAKeyDoesNotApply) {
  const auto json = nlohmann::json::parse(to_json(RunResult{}));
  for (const char* key : {"backend", "data_seed", "position_rmse_m", "key_distances", "chi2"}) {
    EXPECT_TRUE(json.at(key).is_null()) << key;
  }
  EXPECT_TRUE(json.at("stages").is_array());
}

TEST(ResultJson, WritesNumbersThatAreNotFiniteAsNull) {
  RunResult result;
  result.chi2 = std::numeric_limits<double>::quiet_NaN();
  result.wall_s = std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(to_json(result));
  EXPECT_TRUE(json.at("chi2").is_null());
  EXPECT_TRUE(json.at("wall_s").is_null());
}

TEST(ResultJson, KeepsSeedsOf64Bits) {
  RunResult result;
  result.system_seed = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(result_from_json(to_json(result), "t")->system_seed, result.system_seed);
}

TEST(ResultJson, MissingKeysKeepTheirDefaultAndUnknownOnesAreSkipped) {
  const auto result =
      result_from_json(R"({"case_id": "c", "status": "ok", "key_of_tomorrow": 1})", "t");
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->case_id, "c");
  EXPECT_FALSE(result->final_scores.position_rmse_m.has_value());
}

TEST(ResultJson, TellsNothingSetByHandFromARecordThatDoesNotSay) {
  const auto overrides = [](const char* text) { return result_from_json(text, "t")->overrides; };
  EXPECT_FALSE(overrides(R"({"case_id": "c", "status": "ok"})").has_value());
  EXPECT_FALSE(overrides(R"({"case_id": "c", "status": "ok", "overrides": null})").has_value());
  const auto none = overrides(R"({"case_id": "c", "status": "ok", "overrides": {}})");
  ASSERT_TRUE(none.has_value());
  EXPECT_TRUE(none->empty());
  const auto one = overrides(R"({"case_id": "c", "status": "ok", "overrides": {"a_m": "2"}})");
  ASSERT_TRUE(one.has_value());
  EXPECT_EQ(one->at("a_m"), "2");
}

TEST(ResultJson, RefusesWrongTypesUnknownStatusesAndBrokenSyntaxByName) {
  const auto line = [](const char* text) {
    const auto result = result_from_json(text, "r.json");
    return result ? std::string("accepted") : result.error().to_line();
  };
  EXPECT_EQ(line("{\"case_id\""), "r.json: not a JSON object; expected a result record");
  EXPECT_EQ(line(R"({"case_id": "c", "status": "fine"})"),
            "r.json: key \"status\" has a value of the wrong type; expected a result record");
  EXPECT_EQ(line(R"({"case_id": "c", "status": "ok", "threads": "two"})"),
            "r.json: key \"threads\" has a value of the wrong type; expected a result record");
  EXPECT_EQ(line(R"({"case_id": "c", "status": "ok", "threads": 3000000000})"),
            "r.json: key \"threads\" has a value of the wrong type; expected a result record");
  EXPECT_EQ(line(R"({"case_id": "c", "status": "ok", "system_seed": -1})"),
            "r.json: key \"system_seed\" has a value of the wrong type; expected a result record");
  EXPECT_EQ(line("{}"),
            "r.json: keys \"case_id\" and \"status\" are not both there; expected a "
            "result record");
}

TEST(CaseStatusText, NamesEveryStatusAndReadsItBack) {
  for (const char* text :
       {"ok", "partial", "diverged", "failed", "timeout", "out_of_memory", "bad_input"}) {
    const auto status = case_status_from_text(text);
    ASSERT_TRUE(status.has_value()) << text;
    EXPECT_EQ(to_text(*status), text);
  }
  EXPECT_FALSE(case_status_from_text("OK").has_value());
}

}  // namespace
}  // namespace corridor::results
