// The inner loops of the two rivals, in look-ups per second, and what the machine can load at most:
// a look-up that reads 1 of 16 values of a vector cannot be faster than a sixteenth of a load. A
// limit of this layout of the grid; another may have another.
#include <benchmark/benchmark.h>

#include <array>
#include <cstring>

#include "baselines/gmapping/scan_score.hpp"
#include "baselines/karto/correlative_matcher.hpp"
#include "bench/micro/corridor_scans.hpp"

namespace corridor {
namespace {

constexpr double kRange_m = 12;

struct Vector16 {
  using Type [[gnu::vector_size(16)]] = std::uint16_t;
};
struct Vector32 {
  using Type [[gnu::vector_size(32)]] = std::uint16_t;
};

// Loads of one vector from the first-level cache, added up in eight chains; items are loads.
template <class V>
void load(benchmark::State& state) {
  using Vector = typename V::Type;
  constexpr std::size_t kNumChains = 8;
  alignas(64) static std::array<std::uint8_t, 8192> cells{};
  constexpr std::size_t kNumVectors = cells.size() / sizeof(Vector);
  for (auto _ : state) {
    benchmark::DoNotOptimize(cells.data());
    benchmark::ClobberMemory();
    Vector sums[kNumChains] = {};
    for (std::size_t i = 0; i < kNumVectors; i += kNumChains) {
      for (std::size_t k = 0; k < kNumChains; ++k) {
        Vector values;
        std::memcpy(&values, cells.data() + (i + k) * sizeof(Vector), sizeof(Vector));
        sums[k] += values;
      }
    }
    for (std::size_t k = 1; k < kNumChains; ++k) sums[0] += sums[k];
    std::memcpy(cells.data(), sums, sizeof(Vector));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kNumVectors));
}
BENCHMARK(load<Vector16>)->Name("machine/load/16");
BENCHMARK(load<Vector32>)->Name("machine/load/32");

LaserScan far_scan(const Pose2& T_world_base) {
  static const simulation::RayCaster caster(simulation::make_corridor({}));
  return cast_scan(caster, T_world_base, kRange_m);
}

struct KartoScene {
  KartoScene() {
    for (const Pose2& pose : drive_along(70))
      scans.emplace_back(far_scan(pose), pose, karto::KeyScanOptions{});
    for (const karto::KeyScan& scan : scans) local_map.push_back(&scan);
  }

  std::vector<karto::KeyScan> scans;
  std::vector<const karto::KeyScan*> local_map;
};

constexpr karto::GridSpec kSequential{0.01, 0.3, kRange_m, 0.03};
constexpr karto::GridSpec kLoop{0.05, 8.0, kRange_m, 0.03};

// One whole match against 70 scans, by one thread; items are the look-ups that its coarse stage
// answers for, whether it makes them or not.
void match(benchmark::State& state, const karto::GridSpec& spec,
           const karto::MatchOptions& options) {
  const KartoScene scene;
  karto::CorrelativeMatcher matcher(spec, {});
  const karto::KeyScan& scan = scene.scans[35];
  const Pose2 predicted = scan.T_map_sensor() * Pose2(0.04, -0.03, 0.02);
  for (auto _ : state) {
    benchmark::DoNotOptimize(matcher.match(scan, predicted, scene.local_map, options));
  }
  const auto side = static_cast<std::int64_t>(spec.window_m / (2 * spec.resolution_m) + 1.5);
  constexpr std::int64_t kNumHeadings = 21;
  state.SetItemsProcessed(state.iterations() * side * side * kNumHeadings *
                          static_cast<std::int64_t>(kNumBeams));
}
BENCHMARK_CAPTURE(match, sequential, kSequential, {.use_penalty = true})
    ->Name("karto/match/sequential")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(match, loop, kLoop, {.use_refinement = false})
    ->Name("karto/match/loop_all_poses")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(match, bounded, kLoop, {.use_refinement = false, .min_response = 0.8})
    ->Name("karto/match/loop")
    ->Unit(benchmark::kMicrosecond);

// The sweep alone, 21 headings: items are look-ups.
void sweep(benchmark::State& state, const karto::GridSpec& spec, int count) {
  const KartoScene scene;
  karto::CorrelationGrid grid(spec, 1);
  grid.reset(scene.scans[35].T_map_sensor().translation_m());
  grid.blocks().want_all();
  karto::GridCells cells;
  for (const karto::KeyScan& scan : scene.scans) {
    grid.find_cells(scan.points_map_m(), cells);
    grid.occupy(cells, cells.index.size());
  }
  karto::PointColumns beams_m(static_cast<Eigen::Index>(kNumBeams), 2);
  for (std::size_t i = 0; i < kNumBeams; ++i) {
    beams_m.row(static_cast<Eigen::Index>(i)) = scene.scans[35].beams_sensor_m()[i].transpose();
  }
  const int first = grid.middle_cell() - (count - 1);
  const karto::SweepWindow window{first, first, 2, count};
  std::vector<karto::HeadingSweep> headings(21);
  std::vector<std::uint32_t> sums(headings.size() * window.num_positions());
  for (std::size_t i = 0; i < headings.size(); ++i) {
    karto::fill_beam_offsets(beams_m, 0.0349 * (static_cast<double>(i) - 10), grid,
                             headings[i].offsets);
    headings[i].sums = std::span(sums).subspan(i * window.num_positions(), window.num_positions());
  }
  for (auto _ : state) {
    karto::sweep_window(grid, window, karto::EdgeRule::kWrap, 0, headings);
    benchmark::DoNotOptimize(sums.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(sums.size() * kNumBeams));
}
BENCHMARK_CAPTURE(sweep, sequential, kSequential, 16)
    ->Name("karto/sweep/sequential")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(sweep, loop, kLoop, 81)->Name("karto/sweep/loop")->Unit(benchmark::kMicrosecond);

// One score of a scan in a particle's map; items are end points, each looked up in nine cells.
void score(benchmark::State& state) {
  gmapping::EndPointMap map(0.05);
  const gmapping::BeamSelection all{.max_range_m = kRange_m, .tilt_steps = 0, .stride = 1};
  for (const Pose2& pose : drive_along(70)) map.insert(usable_points(far_scan(pose), all), pose);
  const Pose2 pose = drive_along(70)[35] * Pose2(0.03, -0.02, 0.01);
  const gmapping::ScanPoints points = usable_points(far_scan(drive_along(70)[35]), all);
  for (auto _ : state) benchmark::DoNotOptimize(scan_score(map, points, pose, {}));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(score)->Name("gmapping/score")->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace corridor
