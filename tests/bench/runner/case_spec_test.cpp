#include "bench/runner/case_spec.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

namespace corridor::runner {
namespace {

CaseSpec example() {
  CaseSpec spec;
  spec.suite = "paper";
  spec.system = "karto";
  spec.profile = "as-shipped";
  spec.backend = "levenberg";
  spec.overrides = {{"buffer_size_scans", "50"}};
  spec.dataset = "paper-corridor";
  spec.data_source = "paper-corridor";
  spec.data_seed = 3;
  spec.system_seed = 3;
  return spec;
}

std::string draw_text() {
  return *rc::gen::container<std::string>(rc::gen::inRange<char>(' ', '~'));
}

RC_GTEST_PROP(CaseSpec, ReadingWhatWasWrittenGivesTheSameSpec, ()) {
  CaseSpec spec;
  spec.suite = draw_text();
  spec.system = draw_text();
  spec.profile = draw_text();
  if (*rc::gen::arbitrary<bool>()) spec.backend = draw_text();
  spec.overrides[draw_text()] = draw_text();
  spec.data_kind = *rc::gen::element(DataKind::kSimulated, DataKind::kRecorded);
  spec.dataset = draw_text();
  spec.data_source = draw_text();
  if (spec.data_kind == DataKind::kSimulated) spec.data_seed = *rc::gen::arbitrary<std::uint64_t>();
  spec.system_seed = *rc::gen::arbitrary<std::uint64_t>();
  spec.threads = *rc::gen::inRange(1, 100);
  spec.limits.time_s = *rc::gen::inRange(1, 100000) / 7.0;
  spec.limits.memory_mib = *rc::gen::inRange(1, 100000);
  spec.data_digest = draw_text();
  const Result<CaseSpec> again = case_spec_from_json(to_json(spec), "test");
  RC_ASSERT(again.has_value());
  RC_ASSERT(*again == spec);
  RC_ASSERT(case_id(*again) == case_id(spec));
}

TEST(CaseId, IsReadableAndStays) {
  // Written down once: a change of this text makes --resume forget every finished case.
  EXPECT_EQ(case_id(example()), "paper-corridor-s3.karto@as-shipped.levenberg-b494fe56cb3c");
}

TEST(CaseId, DependsOnWhatDecidesTheEstimate) {
  const std::string id = case_id(example());
  CaseSpec other = example();
  other.overrides["buffer_size_scans"] = "51";
  EXPECT_NE(case_id(other), id);
  other = example();
  other.system_seed = 4;
  EXPECT_NE(case_id(other), id);
  other = example();
  other.threads = 2;
  EXPECT_NE(case_id(other), id);
}

TEST(CaseId, DoesNotDependOnLimitsOrTheDataDigest) {
  CaseSpec other = example();
  other.limits.time_s = 1;
  other.data_digest = "abc";
  EXPECT_EQ(case_id(other), case_id(example()));
}

TEST(CaseId, HoldsNoCharacterThatAFileNameMayNotHave) {
  CaseSpec spec = example();
  spec.dataset = "../a b/ü*?";
  EXPECT_EQ(case_id(spec).find_first_of("/ *?"), std::string::npos);
}

std::string refusal(const std::string& text) {
  const Result<CaseSpec> spec = case_spec_from_json(text, "s.json");
  return spec ? "accepted" : spec.error().to_line();
}

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = to_json(example());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(CaseSpec, RefusesBrokenSyntaxMissingAndUnknownKeysAndWrongTypes) {
  EXPECT_EQ(refusal("{"), "s.json: not a JSON object; expected a case as `run` writes it");
  EXPECT_NE(refusal(replaced("\"suite\"", "\"sweet\""))
                .find("key \"suite\" is missing; unknown key "
                      "\"sweet\""),
            std::string::npos);
  EXPECT_NE(refusal(replaced("\"threads\": 1", "\"threads\": \"one\"")).find("\"threads\""),
            std::string::npos);
  EXPECT_NE(refusal(replaced("\"threads\": 1", "\"threads\": 0")).find("threads is below 1"),
            std::string::npos);
  EXPECT_NE(refusal(replaced("\"simulated\"", "\"dreamt\"")).find("data_kind"), std::string::npos);
  EXPECT_NE(refusal(replaced("\"data_seed\": 3", "\"data_seed\": null")).find("data_seed"),
            std::string::npos);
  EXPECT_NE(refusal(replaced("\"time_s\"", "\"time\"")).find("limits"), std::string::npos);
}

TEST(CaseSpec, NamesTheFileThatIsMissing) {
  EXPECT_EQ(read_case_spec("no/such/spec.json").error().where, "no/such/spec.json");
}

}  // namespace
}  // namespace corridor::runner
