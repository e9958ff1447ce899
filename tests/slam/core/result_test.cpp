#include "slam/core/result.hpp"

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(Error, LineSaysWhereWhatAndWhatWasExpected) {
  const Error error{ErrorCode::kInvalid, "range 0", "log.clf:12", "a range > 0"};
  EXPECT_EQ(error.to_line(), "log.clf:12: range 0; expected a range > 0");
}

TEST(Error, LineLeavesOutWhatIsNotKnown) {
  EXPECT_EQ((Error{ErrorCode::kInternal, "no memory", "", ""}).to_line(), "no memory");
  EXPECT_EQ((Error{ErrorCode::kNotFound, "no such file", "a.tum", ""}).to_line(),
            "a.tum: no such file");
  EXPECT_EQ((Error{ErrorCode::kInvalid, "no scan", "", "one"}).to_line(), "no scan; expected one");
}

TEST(Result, HoldsAValueOrAnError) {
  const Result<int> good = 7;
  const Result<int> bad = fail(ErrorCode::kMalformed, "garbage", "byte 5", "a number");
  EXPECT_EQ(good.value(), 7);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().code, ErrorCode::kMalformed);
  EXPECT_EQ(bad.error().to_line(), "byte 5: garbage; expected a number");
}

}  // namespace
}  // namespace corridor
