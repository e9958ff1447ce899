// Axes, frames, the SVG writer and the rasteriser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "reports/figures/raster.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/figures/scale.hpp"
#include "reports/figures/series_styles.hpp"
#include "reports/figures/svg.hpp"
#include "reports/tables/paper_world.hpp"
#include "tests/reports/synthetic_run.hpp"

namespace corridor::figures {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kExact = 1e-9;

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> texts;
  for (const Tick& tick : ticks) texts.push_back(tick.label);
  return texts;
}

TEST(LinearTicks, AreRoundNumbers) {
  EXPECT_THAT(labels(linear_ticks(0, 21, 5)), ::testing::ElementsAre("0", "5", "10", "15", "20"));
  EXPECT_THAT(labels(linear_ticks(0, 0.5, 5)),
              ::testing::ElementsAre("0.0", "0.1", "0.2", "0.3", "0.4", "0.5"));
}

RC_GTEST_PROP(LinearTicks, LieInsideAndAreEvenlySpaced, ()) {
  const double low = *rc::gen::inRange(-100'000, 100'000) * 0.013;
  const double high = low + *rc::gen::inRange(1, 100'000) * 0.017;
  const auto ticks = linear_ticks(low, high, 6);
  const double slack = 1e-6 * (high - low);
  RC_ASSERT(ticks.size() <= 8U);
  for (std::size_t index = 0; index < ticks.size(); ++index) {
    RC_ASSERT(ticks[index].value >= low - slack);
    RC_ASSERT(ticks[index].value <= high + slack);
    if (index == 0) continue;
    RC_ASSERT(std::abs(ticks[index].value - ticks[index - 1].value -
                       (ticks[1].value - ticks[0].value)) < slack);
  }
}

TEST(LogTicks, StandAtOneTwoAndFive) {
  EXPECT_THAT(labels(log_ticks(0.09, 6)),
              ::testing::ElementsAre("0.1", "0.2", "0.5", "1", "2", "5"));
  EXPECT_THAT(labels(log_ticks(0.001, 100)),
              ::testing::ElementsAre("0.001", "0.01", "0.1", "1", "10", "100"));
}

TEST(LogScale, PutsTheGeometricMeanInTheMiddleAndClampsOutside) {
  const LogScale scale(0.01, 100, 200, 400);
  EXPECT_NEAR(scale(1), 300, kExact);
  EXPECT_NEAR(scale(1e9), 400, kExact);
  EXPECT_NEAR(scale(0), 200, kExact);
}

TEST(PlaneFrame, KeepsTheAspectAndTurnsYUp) {
  Bounds bounds;
  bounds.include({0, 0});
  bounds.include({20, 10});
  const PlaneFrame frame(bounds, 0, 0, 220, 220, 10);
  EXPECT_NEAR(frame.px_per_m(), 10, kExact);
  EXPECT_NEAR(frame({0, 0}).x(), 10, kExact);
  EXPECT_NEAR(frame({20, 10}).x(), 210, kExact);
  EXPECT_NEAR(frame({0, 0}).y() - frame({0, 10}).y(), 100, kExact);
}

TEST(PlaneFrame, OfNothingStaysFinite) {
  EXPECT_TRUE(PlaneFrame(Bounds{}, 0, 0, 100, 100, 10)({1, 1}).allFinite());
}

TEST(Svg, EscapesEveryTextAndStaysWellFormed) {
  const std::string hostile = "</text><script>alert(1)</script>\" & ' \x01 \xFF ]]>";
  Svg svg(hostile, 200, 100, hostile, hostile);
  svg.text(10, 20, hostile);
  svg.begin_clip(0, 0, 50, 50);
  svg.line(0, 0, 10, 10, "axis");
  svg.end_group();
  EXPECT_THAT(svg.file(), Not(HasSubstr("<script")));
  EXPECT_TRUE(png_from_svg(svg.file(), 1));
}

TEST(Svg, CarriesNoStyleInsideThePageAndOneInItsFile) {
  const Svg svg("x", 10, 10, "title", "description");
  EXPECT_THAT(svg.element(), Not(HasSubstr("<style")));
  EXPECT_THAT(svg.file(), HasSubstr("<style>"));
  EXPECT_THAT(svg.file(), HasSubstr("prefers-color-scheme:dark"));
}

TEST(PngFromSvg, RefusesWhatIsNoSvg) {
  const auto png = png_from_svg("<svg", 1);
  ASSERT_FALSE(png);
  EXPECT_THAT(png.error().to_line(), HasSubstr("librsvg"));
}

TEST(PngFromSvg, IsLightWhateverTheDarkRulesSay) {
  const Svg svg("x", 4, 4, "title", "description");
  const auto png = png_from_svg(svg.file(), 1);
  const Svg other("x", 4, 4, "other title", "");
  ASSERT_TRUE(png);
  EXPECT_EQ(png->substr(1, 3), "PNG");
  EXPECT_EQ(*png, *png_from_svg(other.file(), 1));
}

TEST(PngFromPixels, GivesTheSameBytesForTheSamePixels) {
  const PixelImage image{2, 1, {0xFF000000, 0x00FFFFFF}};
  const auto first = png_from_pixels(image);
  ASSERT_TRUE(first);
  EXPECT_EQ(*first, *png_from_pixels(image));
}

TEST(SeriesStyles, GiveProfilesOfOneSystemAndUnknownSystemsStylesOfTheirOwn) {
  std::vector<reports::Case> all(3);
  all[0].result.system = all[1].result.system = "karto";
  all[1].result.profile = "tuned";
  all[2].result.system = "<script>";
  const reports::Cases cases(all, {}, {});
  const SeriesStyles styles(cases);
  EXPECT_EQ(styles({"karto", "", ""}).name, "karto");
  EXPECT_EQ(styles({"karto", "tuned", ""}).name, "spare-0");
  EXPECT_EQ(styles({"<script>", "", ""}).name, "spare-1");
}

TEST(Elided, KeepsWhatFitsAndCutsBetweenCharacters) {
  EXPECT_EQ(elided("karto", 200), "karto");
  const std::string cut = elided(std::string(20, 'x') + "äöüäöüäöüäöüäöü", 200);
  EXPECT_LE(text_width_px(cut), 200);
  EXPECT_TRUE(cut.ends_with("…"));
  EXPECT_EQ(elided("ä", 1), "…");
  const std::string wide = elided("ääääääääääääääääääää", 60);
  EXPECT_EQ((wide.size() - std::string_view("…").size()) % 2, 0U);  // no half of an "ä"
}

TEST(LabelColumn, GrowsWithItsLabelsWithinLimits) {
  EXPECT_EQ(label_column_px({"a"}), label_column_px({}));
  EXPECT_GT(label_column_px({"karto (num_particles=99)"}), label_column_px({"karto"}));
  EXPECT_EQ(label_column_px({std::string(300, 'x')}), label_column_px({std::string(400, 'x')}));
}

// Eight worlds of each length, in all of which fusion is better.
std::vector<results::RunResult> sweep_results(const std::vector<std::string>& lengths) {
  std::vector<results::RunResult> results;
  for (const std::string& length : lengths) {
    reports::testing::SyntheticRun run =
        reports::testing::run_of({{"fusion", 0.01}, {"karto", 0.5}});
    run.dataset = "corridor-length@" + length;
    for (const auto& result : reports::testing::synthetic_results(run)) results.push_back(result);
  }
  return results;
}

TEST(Family, IsWhatStandsBeforeTheLastAt) {
  EXPECT_EQ(family_of("corridor-range@4.5"), "corridor-range");
  EXPECT_EQ(family_of("a@b@3"), "a@b");
  EXPECT_EQ(family_of("intel"), "");
}

TEST(SweepFigure, OrdersValuesBySizeAndSaysWhoIsShownToBeTheBestWhere) {
  auto results = sweep_results({"100", "20", "3.5"});
  for (auto& result : results) {  // at 20 both systems have the same error in every world
    if (result.dataset == "corridor-length@20") result.final_scores.position_rmse_m = 0.1;
  }
  const auto figure = sweep_figure(reports::testing::make_cases(results), "corridor-length");
  ASSERT_TRUE(figure);
  EXPECT_THAT(figure->caption, HasSubstr("position: fusion at 3.5, 100; nobody at 20."));
  const std::string svg = figure->svg.element();
  EXPECT_LT(svg.find(">3.5</text>"), svg.find(">20</text>"));
  EXPECT_LT(svg.find(">20</text>"), svg.find(">100</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("Cramer-Rao")));  // no record has a bound
}

TEST(SweepFigure, DrawsTheBoundWhereRecordsHaveOne) {
  auto results = sweep_results({"20", "100"});
  for (auto& result : results) result.bound_position_rmse_m = 0.004;
  const auto figure = sweep_figure(reports::testing::make_cases(results), "corridor-length");
  ASSERT_TRUE(figure);
  EXPECT_THAT(figure->svg.element(), HasSubstr("Cramer-Rao bound"));
}

TEST(SweepFigure, OfOneValueIsNone) {
  EXPECT_FALSE(
      sweep_figure(reports::testing::make_cases(sweep_results({"20"})), "corridor-length"));
}

TEST(StageFigure, ShowsEveryStageThatMattersWithShareAndCount) {
  const auto run = reports::testing::paper_like_run();
  std::vector<reports::Case> all;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    all.push_back({reports::testing::synthetic_result(run, {"gmapping", 0.1}, seed), {}});
    all.back().result.stages.push_back({"other", 500, 1e-4, 1, 1, 1, 1});  // below 1 %
  }
  const auto figure = stage_figure(reports::Cases(all, {}, {}), run.dataset);
  ASSERT_TRUE(figure);
  EXPECT_THAT(figure->svg.element(),
              ::testing::AllOf(HasSubstr("time [ms]"), HasSubstr(">match<"),
                               HasSubstr(">resample<"), HasSubstr("74 %, n = 500"),
                               HasSubstr("85.0 × real time"), Not(HasSubstr(">other<"))));
}

TEST(StageFigure, WithoutTimesIsNone) {
  std::vector<reports::Case> all(1);
  all[0].result.system = "karto";
  EXPECT_FALSE(stage_figure(reports::Cases(all, {}, {}), ""));
}

TEST(PaperCounterpart, IsTheShippedProfileOnly) {
  const auto run = reports::testing::paper_like_run();
  std::vector<reports::Case> all;
  for (const char* profile : {"as-shipped", "corrected"}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      all.push_back({reports::testing::synthetic_result(run, {"karto", 0.1}, seed), {}});
      all.back().result.profile = profile;
    }
  }
  const reports::Cases cases(all, {}, {});
  EXPECT_TRUE(tables::is_paper_counterpart(cases, cases.series()[0]));
  EXPECT_FALSE(tables::is_paper_counterpart(cases, cases.series()[1]));
  all[0].result.parameters_hash = "other";  // which of the two was as shipped?
  const reports::Cases unclear(all, {}, {});
  EXPECT_FALSE(tables::is_paper_counterpart(unclear, unclear.series()[0]));
}

TEST(RepresentativeWorld, IsTheOneOfKartosMedianError) {
  const auto run = reports::testing::paper_like_run();
  std::vector<reports::Case> all;
  std::vector<double> errors_m;
  for (const auto& system : run.systems) {
    for (std::uint64_t seed = 1; seed <= 7; ++seed) {
      all.push_back({reports::testing::synthetic_result(run, system, seed), {}});
      if (system.name == "karto") {
        errors_m.push_back(*all.back().result.final_scores.position_rmse_m);
      }
    }
  }
  const auto chosen = representative_world(reports::Cases(all, {}, {}), run.dataset);
  ASSERT_TRUE(chosen);
  const double error_m = errors_m[static_cast<std::size_t>(*chosen->world.data_seed) - 1];
  std::sort(errors_m.begin(), errors_m.end());
  EXPECT_EQ(error_m, errors_m[3]);
  EXPECT_THAT(chosen->reason, HasSubstr("karto"));
  EXPECT_THAT(chosen->reason, HasSubstr("m, is the median of its 7 worlds."));
}

TEST(RepresentativeWorld, OfAnEvenNumberIsTheOneClosestToTheMedianAndNoneIsTheMedian) {
  const auto run = reports::testing::paper_like_run();
  std::vector<reports::Case> all;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    all.push_back({reports::testing::synthetic_result(run, {"karto", 0.1}, seed), {}});
    all.back().result.final_scores.position_rmse_m = seed == 1 ? 0.620 : 0.202;
  }
  const auto chosen = representative_world(reports::Cases(all, {}, {}), run.dataset);
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->world.data_seed, 2U);
  EXPECT_EQ(chosen->reason,
            "World 2 of synthetic-corridor, chosen because karto's position error there, 0.202 m, "
            "is closest to its median over 2 worlds, 0.411 m.");
}

}  // namespace
}  // namespace corridor::figures
