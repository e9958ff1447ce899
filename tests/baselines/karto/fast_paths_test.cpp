// The program's matcher against the matcher by its definition: the same numbers, bit by bit.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <tbb/task_arena.h>

#include <array>
#include <limits>

#include "baselines/karto/correlative_matcher.hpp"
#include "baselines/karto/mapper.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "tests/baselines/karto/plain_matcher.hpp"
#include "tests/support/room_drive.hpp"

namespace corridor::karto {
namespace {

// A match in the room at a range so short that part of its walls is not seen.
struct Scene {
  KartoParams params;
  MatchOptions options;
  GridSpec spec;
  float no_return_m = 0;  // raw range of a beam without return
};

KeyScan scan_at(const Pose2& T_map_base, const Scene& scene, Rng& rng) {
  const double range_m = scene.spec.reach_m;
  LaserScan scan =
      corridor::testing::scan_of(corridor::testing::room(), T_map_base, range_m, 0.01, rng);
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    if (scan.is_valid[i] == 0) scan.ranges_m[i] = scene.no_return_m;
  }
  return {scan, T_map_base, {range_m, true, scene.params.count_no_returns}};
}

Pose2 near(const Pose2& pose, double position_m, double heading_rad, Rng& rng) {
  return {pose.x_m() + rng.uniform(-position_m, position_m),
          pose.y_m() + rng.uniform(-position_m, position_m),
          pose.theta_rad() + rng.uniform(-heading_rad, heading_rad)};
}

bool are_equal(const MatchResult& a, const MatchResult& b) {
  return a.response == b.response && a.T_map_sensor == b.T_map_sensor &&
         a.covariance_map == b.covariance_map;
}

void expect_the_same_by_definition(Scene scene, Rng& rng) {
  const Pose2 truth(rng.uniform(-2, 2), rng.uniform(-1.5, 1.5), rng.uniform(-3, 3));
  std::vector<KeyScan> map;
  for (int i = 0; i < 3; ++i) map.push_back(scan_at(near(truth, 0.8, 1, rng), scene, rng));
  const std::vector<const KeyScan*> local_map = {&map[0], &map[1], &map[2]};
  const KeyScan scan = scan_at(truth, scene, rng);
  const Pose2 guess = near(truth, 0.2, 0.4, rng);

  const MatchResult plain =
      testing::PlainMatcher(scene.spec, scene.params).match(scan, guess, local_map, scene.options);
  CorrelativeMatcher matcher(scene.spec, scene.params);
  tbb::task_arena threads(1 + static_cast<int>(rng.below(4)));
  const auto match_with = [&](const KeyScan& key_scan, const Pose2& predicted,
                              const MatchOptions& options) {
    return threads.execute([&] { return matcher.match(key_scan, predicted, local_map, options); });
  };
  scene.options.use_threads = true;
  // What an earlier match left in its memory must not show.
  (void)match_with(map[0], near(truth, 1, 1, rng), {});
  RC_ASSERT(are_equal(match_with(scan, guess, scene.options), plain));

  // A search that gives up what is not taken: the same where it is taken, and not taken where not.
  scene.options.min_response = rng.uniform(0.2, 1.0);
  const MatchResult bounded = match_with(scan, guess, scene.options);
  const bool is_taken = plain.response > scene.options.min_response;
  const bool is_right =
      is_taken ? are_equal(bounded, plain) : bounded.response <= scene.options.min_response;
  RC_ASSERT(is_right);
}

RC_GTEST_PROP(CorrelativeMatcher, GivesWhatTryingEveryPoseForItselfGives, (std::uint64_t seed)) {
  Rng rng(seed);
  Scene scene;
  scene.params.count_no_returns = rng.below(2) == 0;
  scene.params.wrap_rows = rng.below(2) == 0;
  scene.params.use_response_expansion = rng.below(4) == 0;
  scene.options = {.use_penalty = rng.below(2) == 0, .use_refinement = rng.below(3) > 0};
  scene.spec = rng.below(2) == 0 ? GridSpec{0.01, 0.3, 3.5, 0.03} : GridSpec{0.05, 3.2, 3.5, 0.05};
  // Just beyond the range, in the grid's corners, in another row of it, nowhere.
  const std::array<float, 5> no_returns_m = {3.6F, 4.5F, 20, 81.83F,
                                             std::numeric_limits<float>::quiet_NaN()};
  scene.no_return_m = no_returns_m[rng.below(5)];
  expect_the_same_by_definition(scene, rng);
}

// Lattices that the defaults do not have: a fine search that reaches beyond half a coarse step, an
// even grid, a kernel of 41 cells.
RC_GTEST_PROP(CorrelativeMatcher, GivesThatWithUnusualParametersToo, (std::uint64_t seed)) {
  Rng rng(seed);
  Scene scene;
  scene.params.coarse_angle_resolution_rad = rng.uniform(0.02, 0.3);
  scene.params.coarse_angle_offset_rad = rng.uniform(0.0, 0.5);
  scene.params.fine_angle_resolution_rad = rng.uniform(0.004, 0.1);
  scene.spec.resolution_m = rng.uniform(0.02, 0.04);
  scene.spec.window_m = rng.uniform(0.05, 0.6);
  scene.spec.smear_m = rng.uniform(0.5, 10) * scene.spec.resolution_m;
  scene.spec.reach_m = rng.uniform(1.5, 4);
  scene.no_return_m = static_cast<float>(rng.uniform(2, 30));
  expect_the_same_by_definition(scene, rng);
}

// Headings shared out among parts that draw only what is theirs: the walls of one part's headings
// lie beyond what the next one's margin covers.
RC_GTEST_PROP(CorrelativeMatcher, GivesThatForAWideWindowOfSmallCellsToo, (std::uint64_t seed)) {
  Rng rng(seed);
  Scene scene;
  scene.spec = {0.015, 1.0, 4, 0.03};
  scene.no_return_m = 5;
  expect_the_same_by_definition(scene, rng);
}

// A kernel so wide that a stamp occupies its neighbours.
RC_GTEST_PROP(CorrelativeMatcher, GivesThatWithTheWidestKernelToo, (std::uint64_t seed)) {
  Rng rng(seed);
  Scene scene;
  // One part, or several that draw in turn.
  scene.spec = {0.02, rng.below(2) == 0 ? 0.3 : 1.4, 2.5, 0.2};
  scene.no_return_m = 3;
  expect_the_same_by_definition(scene, rng);
}

// Headings that tie on both sides of half a turn: their mean is not between them.
RC_GTEST_PROP(CorrelativeMatcher, GivesThatForAllHeadingsToo, (std::uint64_t seed)) {
  Rng rng(seed);
  Scene scene;
  scene.spec = {0.04, rng.below(2) == 0 ? 0.3 : 1.4, 2.5, 0.05};
  scene.params.coarse_angle_offset_rad = rng.uniform(1.2, 3.2);
  scene.params.coarse_angle_resolution_rad = rng.uniform(0.1, 1.0);
  scene.no_return_m = 3;
  expect_the_same_by_definition(scene, rng);
}

// Beams that run on into other rows of the grid turn far between two headings of the coarse search.
RC_GTEST_PROP(CorrelativeMatcher, GivesThatForBeamsFarBeyondTheGridToo, (std::uint64_t seed)) {
  Rng rng(seed);
  Scene scene;
  scene.spec = {0.01, 0.3, 1.5, 0.03};
  scene.no_return_m = static_cast<float>(rng.uniform(5, 90));
  expect_the_same_by_definition(scene, rng);
}

template <class Matcher>
ScanMatcher make_matcher(const GridSpec& spec, const KartoParams& params) {
  const auto matcher = std::make_shared<Matcher>(spec, params);
  return [matcher](const auto&... arguments) { return matcher->match(arguments...); };
}

// Two rounds through the room, every scan a key scan, with near chains and closed loops.
class TwoRounds {
 public:
  TwoRounds(const MatcherFactory& make_matcher, int num_threads, double match_window_m = 0.3)
      : mapper_(params(match_window_m), kRange_m,
                PoseGraph(backend::make_least_squares(backend::spa_params()), {}), clock_,
                num_threads, make_matcher) {
    Pose2 T_odom_last;
    Pose2 T_odom_base;
    for (int round = 0; round < 2; ++round) {
      const SensorLog log = corridor::testing::room_log({.num_scans = 36, .odometry_scale = 1.02});
      const Pose2 T_odom_start = T_odom_base;
      for (const SensorEvent& event : log.events) {
        if (const auto* wheels = std::get_if<WheelSample>(&event)) {
          T_odom_base = T_odom_start * wheels->T_odom_base;
        }
        const auto* scan = std::get_if<LaserScan>(&event);
        if (scan == nullptr) continue;
        KeyScan key_scan(*scan, T_odom_base, {kRange_m, false, true});
        if (!mapper_.scans().empty()) {
          key_scan.set_T_map_sensor(mapper_.scans().back().T_map_base() *
                                    T_odom_last.between(T_odom_base));
        }
        T_odom_last = T_odom_base;
        mapper_.add(std::move(key_scan));
      }
    }
  }

  [[nodiscard]] const Mapper& mapper() const { return mapper_; }

 private:
  static constexpr double kRange_m = 12;

  static KartoParams params(double match_window_m) {
    KartoParams params;
    params.match_window_m = match_window_m;
    params.use_barycentre = false;
    params.buffer_size_scans = 8;
    params.link_max_distance_m = 0.9;
    params.loop_max_distance_m = 0.9;
    params.loop_min_chain_scans = 3;
    params.loop_window_m = 1;
    params.link_min_response = params.loop_min_response_coarse = params.loop_min_response_fine =
        0.5;
    return params;
  }

  StageClock clock_;
  Mapper mapper_;
};

TEST(Mapper, GivesTheSameRunWithTheMatcherByItsDefinitionAndWithAnyNumberOfThreads) {
  const TwoRounds plain(make_matcher<testing::PlainMatcher>, 1);
  const MapperCounters& counters = plain.mapper().counters();
  ASSERT_GT(counters.near_chain_matches, 10);
  ASSERT_GT(counters.loop_closures, 0);
  for (const int num_threads : {1, 2}) {
    const TwoRounds fast(make_matcher<CorrelativeMatcher>, num_threads);
    ASSERT_EQ(fast.mapper().scans().size(), plain.mapper().scans().size());
    for (std::size_t i = 0; i < plain.mapper().scans().size(); ++i) {
      EXPECT_EQ(fast.mapper().scans()[i].T_map_sensor(), plain.mapper().scans()[i].T_map_sensor())
          << "scan " << i << ", " << num_threads << " threads";
    }
    EXPECT_EQ(fast.mapper().counters().near_chain_links, counters.near_chain_links);
    EXPECT_EQ(fast.mapper().counters().coarse_loop_matches, counters.coarse_loop_matches);
    EXPECT_EQ(fast.mapper().counters().loop_closures, counters.loop_closures);
  }
}

// Of a wide window the headings are shared out as well.
TEST(Mapper, GivesTheSameRunWithAnyNumberOfThreadsForAWideWindowToo) {
  const TwoRounds alone(make_matcher<CorrelativeMatcher>, 1, 0.9);
  const TwoRounds together(make_matcher<CorrelativeMatcher>, 2, 0.9);
  ASSERT_GT(alone.mapper().counters().near_chain_matches, 10);
  for (std::size_t i = 0; i < alone.mapper().scans().size(); ++i) {
    EXPECT_EQ(together.mapper().scans()[i].T_map_sensor(), alone.mapper().scans()[i].T_map_sensor())
        << "scan " << i;
  }
}

}  // namespace
}  // namespace corridor::karto
