#include "bench/results/results_store.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>

#include "bench/results/result_json.hpp"
#include "tests/bench/results/random_result.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::results {
namespace {

using testing::ScratchFolder;

RunResult result_named(const std::string& case_id) {
  RunResult result;
  result.case_id = case_id;
  result.status = CaseStatus::kOk;
  return result;
}

// The first column of the first row, as text.
std::string query(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* database = nullptr;
  sqlite3_stmt* statement = nullptr;
  sqlite3_open(path.c_str(), &database);
  sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr);
  std::string text = "no row";
  if (sqlite3_step(statement) == SQLITE_ROW) {
    const unsigned char* value = sqlite3_column_text(statement, 0);
    text = value == nullptr ? "null" : reinterpret_cast<const char*>(value);
  }
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return text;
}

RC_GTEST_PROP(ResultsStore, ReadsBackWhatWasPutWithTheLastOfEachCaseId, ()) {
  const ScratchFolder folder;
  std::map<std::string, std::string> expected;
  std::vector<RunResult> results;
  const int num_results = *rc::gen::inRange(0, 6);
  for (int i = 0; i < num_results; ++i) {
    results.push_back(draw_result());
    results.back().case_id = "case-" + std::to_string(*rc::gen::inRange(0, 4));
    expected[results.back().case_id] = to_json(results.back());
  }
  auto store = ResultsStore::open(folder / "results.sqlite");
  RC_ASSERT(store.has_value());
  RC_ASSERT(store->put(results).has_value());
  const auto read = ResultsStore::open_read_only(folder / "results.sqlite")->read_all();
  RC_ASSERT(read.has_value());
  RC_ASSERT(read->size() == expected.size());
  for (const RunResult& result : *read) RC_ASSERT(to_json(result) == expected[result.case_id]);
}

TEST(ResultsStore, HasAColumnPerScalarKeyWithItsValue) {
  const ScratchFolder folder;
  RunResult result = result_named("c");
  result.final_scores.position_rmse_m = 0.25;
  result.rendered_map.map_chamfer_m = 0.5;
  result.system_seed = std::numeric_limits<std::uint64_t>::max();
  ASSERT_TRUE(ResultsStore::open(folder / "results.sqlite")->put({result}));
  EXPECT_EQ(query(folder / "results.sqlite", "SELECT position_rmse_m FROM cases"), "0.25");
  EXPECT_EQ(query(folder / "results.sqlite", "SELECT rendered_map_chamfer_m FROM cases"), "0.5");
  EXPECT_EQ(query(folder / "results.sqlite", "SELECT online_position_rmse_m FROM cases"), "null");
  EXPECT_EQ(query(folder / "results.sqlite", "SELECT system_seed FROM cases"),
            "18446744073709551615");
  EXPECT_EQ(query(folder / "results.sqlite", "SELECT status FROM cases"), "ok");
}

TEST(ResultsStore, KeepsMachines) {
  const ScratchFolder folder;
  const Machine machine = this_machine();
  auto store = ResultsStore::open(folder / "results.sqlite");
  ASSERT_TRUE(store->put(machine));
  ASSERT_TRUE(store->put(machine));
  EXPECT_EQ(store->read_machines().value(), std::vector<Machine>{machine});
  EXPECT_EQ(machine.machine_id.size(), 12U);
}

TEST(ResultsStore, AddsTheColumnsThatAnOlderStoreLacks) {
  const ScratchFolder folder;
  ASSERT_TRUE(ResultsStore::open(folder / "results.sqlite")->put({result_named("old")}));
  query(folder / "results.sqlite", "ALTER TABLE cases DROP COLUMN chi2");
  auto store = ResultsStore::open(folder / "results.sqlite");
  ASSERT_TRUE(store.has_value());
  RunResult result = result_named("new");
  result.chi2 = 2.0;
  ASSERT_TRUE(store->put({result}));
  EXPECT_EQ(query(folder / "results.sqlite", "SELECT chi2 FROM cases WHERE case_id = 'new'"),
            "2.0");
  EXPECT_EQ(store->read_all()->size(), 2U);
}

TEST(ResultsStore, PutsAllOrNothing) {
  const ScratchFolder folder;
  auto store = ResultsStore::open(folder / "results.sqlite");
  query(folder / "results.sqlite",
        "CREATE TRIGGER no_bad BEFORE INSERT ON cases WHEN NEW.case_id = 'bad' "
        "BEGIN SELECT RAISE(ABORT, 'bad row'); END");
  EXPECT_FALSE(store->put({result_named("good"), result_named("bad")}).has_value());
  EXPECT_TRUE(store->read_all()->empty());
  EXPECT_TRUE(store->put({result_named("good")}).has_value());
}

TEST(ResultsStore, RefusesForeignFilesAndCreatesNothingWhenReading) {
  const ScratchFolder folder;
  EXPECT_EQ(ResultsStore::open_read_only(folder / "results.sqlite").error().code,
            ErrorCode::kNotFound);
  EXPECT_FALSE(std::filesystem::exists(folder / "results.sqlite"));
  std::ofstream(folder / "results.sqlite")
      << "This is a text, and long enough not to be taken for an empty file.";
  EXPECT_FALSE(ResultsStore::open(folder / "results.sqlite").has_value());
  std::filesystem::remove(folder / "results.sqlite");
  query(folder / "results.sqlite", "CREATE TABLE theirs (x)");
  EXPECT_NE(ResultsStore::open(folder / "results.sqlite").error().what.find("another program"),
            std::string::npos);
}

}  // namespace
}  // namespace corridor::results
