#include "bench/runner/systems.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "baselines/dead_reckoning/dead_reckoning.hpp"
#include "baselines/gmapping/gmapping_slam.hpp"
#include "baselines/karto/karto_slam.hpp"
#include "baselines/mrpt/mrpt_icp.hpp"
#include "baselines/mrpt/mrpt_rbpf.hpp"
#include "bench/runner/back_ends.hpp"
#include "bench/runner/system_entry.hpp"
#include "bench/tuning/tuned_params.hpp"
#include "slam/core/expect.hpp"
#include "slam/core/rng.hpp"
#include "slam/fusion/ablations.hpp"
#include "slam/fusion/fusion_slam.hpp"

namespace corridor::runner {
namespace {

using SystemResult = Result<std::unique_ptr<SlamSystem>>;

// Every system draws from its own stream, so that a system and a simulator with the same seed share
// no number.
Rng rng_of(const SystemRequest& request) { return Rng(request.seed).stream("system"); }

// The back-end that is asked for, else the system's own.
Result<std::unique_ptr<backend::BackEnd>> back_end_for(
    const SystemRequest& request, std::string_view own,
    const backend::LeastSquaresParams& settings) {
  auto back_end =
      make_back_end(request.backend ? *request.backend : own, settings, request.backend_overrides);
  if (back_end && request.wrap_back_end) return request.wrap_back_end(std::move(*back_end));
  return back_end;
}

// The default profile (the first) with what a search found on top, if there was one.
template <class P>
std::vector<Profile<P>> with_tuned(std::string_view system, std::vector<Profile<P>> profiles) {
  for (const tuning::TunedParams& tuned : tuning::all_tuned_params()) {
    if (tuned.system != system) continue;
    const Result<P> params = with_overrides(profiles.front().params, tuned.overrides, "tuned");
    CORRIDOR_EXPECT(params.has_value());
    profiles.push_back(
        {"tuned",
         fmt::format("the best of {} candidates on {} development worlds (search {})",
                     tuned.num_candidates, tuned.num_worlds, tuned.search_sha256.substr(0, 12)),
         *params});
  }
  return profiles;
}

SystemInfo gmapping_entry() {
  SystemInfo info;
  info.name = "gmapping";
  info.description = "GMapping-style Rao-Blackwellised particle filter [Grisetti2007]";
  info.needs_wheels = true;
  info.is_stochastic = true;
  set_factory<gmapping::GmappingParams>(
      info,
      with_tuned<gmapping::GmappingParams>("gmapping",
                                           {{"as-shipped", "as its ROS node ships", {}},
                                            {"as-published",
                                             "with two things of its paper: poses drawn around the "
                                             "match, a free cell before an end point",
                                             gmapping::published_params()},
                                            {"gyro-odometry",
                                             "as-shipped, its odometry's turns corrected by a gyro",
                                             {.use_gyro_odometry = true}}}),
      [](const gmapping::GmappingParams& params, const SystemRequest& request) -> SystemResult {
        return gmapping::make_gmapping(params, request.robot, rng_of(request), request.threads);
      });
  return info;
}

SystemInfo karto_entry() {
  SystemInfo info;
  info.name = "karto";
  info.description = "Karto-style correlative scan matching and pose graph [Konolige2010]";
  info.needs_wheels = true;
  info.default_backend = "levenberg";
  set_factory<karto::KartoParams>(
      info,
      with_tuned<karto::KartoParams>(
          "karto",
          {{"as-shipped", "as the original ships", {}},
           {"corrected",
            "what its paper intends: no-returns ignored, look-ups checked, headings weighted",
            karto::corrected_params()},
           {"gyro-odometry",
            "as-shipped, its odometry's turns corrected by a gyro",
            {.use_gyro_odometry = true}},
           {"slam-toolbox", "the parameters of slam_toolbox, with Karto's method",
            karto::slam_toolbox_params()}}),
      [](const karto::KartoParams& params, const SystemRequest& request) -> SystemResult {
        auto back_end = back_end_for(request, "levenberg", backend::spa_params());
        if (!back_end) return tl::make_unexpected(back_end.error());
        return karto::make_karto(params, request.robot, std::move(*back_end), request.threads);
      });
  return info;
}

SystemInfo dead_reckoning_entry(bool use_gyro) {
  SystemInfo info;
  info.name = use_gyro ? "dead-reckoning-gyro" : "dead-reckoning";
  info.description = use_gyro ? "the wheels' path with the gyro's heading, no map"
                              : "the wheels alone, no map: the floor";
  info.needs_wheels = true;
  info.needs_imu = use_gyro;
  dead_reckoning::DeadReckoningParams defaults;
  defaults.use_gyro = use_gyro;
  set_factory<dead_reckoning::DeadReckoningParams>(
      info, {{"default", "the defaults", defaults}},
      [](const dead_reckoning::DeadReckoningParams& params, const SystemRequest& request)
          -> SystemResult { return dead_reckoning::make_dead_reckoning(params, request.robot); });
  return info;
}

SystemInfo mrpt_icp_entry() {
  SystemInfo info;
  info.name = "mrpt-icp";
  info.description = "MRPT's own ICP-SLAM, a third-party reference";
  set_factory<mrpt::MrptIcpParams>(
      info,
      {{"dense", "a match every 5 cm against a scan every 30 cm, with all points",
        mrpt::dense_icp_params()},
       {"as-shipped", "as MRPT's classic example is configured", {}}},
      [](const mrpt::MrptIcpParams& params, const SystemRequest& request) -> SystemResult {
        return mrpt::make_mrpt_icp(params, request.robot);
      });
  return info;
}

SystemInfo mrpt_rbpf_entry() {
  SystemInfo info;
  info.name = "mrpt-rbpf";
  info.description = "MRPT's own RBPF-SLAM, a third-party reference";
  info.needs_wheels = true;
  info.is_stochastic = true;
  set_factory<mrpt::MrptRbpfParams>(
      info,
      {{"dense", "proposals by ICP of every point every 20 cm against a scan every metre",
        mrpt::dense_rbpf_params()},
       {"as-shipped-icp", "as MRPT's example with ICP proposals for intel is configured",
        mrpt::icp_rbpf_params()},
       {"as-shipped", "as MRPT's grid mapping example with optimal sampling is configured", {}}},
      [](const mrpt::MrptRbpfParams& params, const SystemRequest& request) -> SystemResult {
        return mrpt::make_mrpt_rbpf(params, request.robot, rng_of(request));
      });
  return info;
}

auto fusion_factory(const std::string& name) {
  return [name](const fusion::FusionParams& params, const SystemRequest& request) -> SystemResult {
    auto back_end = back_end_for(request, "isam2", {});
    if (!back_end) return tl::make_unexpected(back_end.error());
    return fusion::make_fusion(name, params, request.robot, std::move(*back_end));
  };
}

SystemInfo fusion_paper_entry() {
  SystemInfo info;
  info.name = "fusion-paper";
  info.description = "LiDAR, IMU and wheels in a factor graph, as published";
  info.needs_imu = true;
  info.default_backend = "isam2";
  set_factory<fusion::FusionParams>(
      info,
      {{"published", "the published method", fusion::fusion_paper_params()},
       {"with-directions", "the LiDAR left out along the directions alone that it does not see",
        fusion::fusion_paper_with_directions()}},
      fusion_factory(info.name));
  return info;
}

SystemInfo fusion_entry() {
  SystemInfo info;
  info.name = "fusion";
  info.description = "LiDAR, IMU and wheels in a factor graph, per direction, with loop closing";
  info.default_backend = "isam2";
  std::vector<Profile<fusion::FusionParams>> profiles =
      with_tuned<fusion::FusionParams>("fusion", {{"default", "the defaults", {}}});
  for (const fusion::Ablation& ablation : fusion::ablations()) {
    profiles.push_back({ablation.name, ablation.description, ablation.params});
  }
  set_factory<fusion::FusionParams>(info, profiles, fusion_factory(info.name));
  return info;
}

SystemInfo graph_batch_entry() {
  SystemInfo info;
  info.name = "graph-batch";
  info.description = "a pose graph solved at once by a back-end";
  info.default_backend = "gauss-newton";
  info.is_stochastic = true;
  using P = GraphBatchParams;
  // A heading's noise is what decides; a position's is that of a robot a few metres off its way.
  const auto near = [](double heading_sigma_rad) {
    return P{.start = "optimum",
             .start_position_sigma_m = 10 * heading_sigma_rad,
             .start_heading_sigma_rad = heading_sigma_rad};
  };
  std::vector<Profile<P>> profiles = {
      {"file", "from the file's poses, or as its system gave them", {}},
      {"odometry", "from chained edges", {.start = "odometry"}},
      {"chordal", "from chordal relaxation", {.start = "chordal"}},
      {"near-0.05", "from the optimum with noise of 0.05 rad and 0.5 m", near(0.05)},
      {"near-0.1", "from the optimum with noise of 0.1 rad and 1 m", near(0.1)},
      {"near-0.2", "from the optimum with noise of 0.2 rad and 2 m", near(0.2)},
      {"near-0.4", "from the optimum with noise of 0.4 rad and 4 m", near(0.4)},
      {"near-0.8", "from the optimum with noise of 0.8 rad and 8 m", near(0.8)}};
  for (const char* robust : {"none", "huber", "dcs", "gnc", "pcm"}) {
    for (const int percent : {0, 10, 20, 30, 40, 50}) {
      P params{.start = "odometry"};
      params.robust = robust;
      params.false_closures = percent / 100.0;
      profiles.push_back({fmt::format("{}-false-{}", robust, percent),
                          fmt::format("from chained edges, {} % of the closures false, robust = {}",
                                      percent, robust),
                          params});
    }
  }
  set_graph_task<P>(info, profiles);
  return info;
}

SystemInfo graph_incremental_entry() {
  SystemInfo info;
  info.name = "graph-incremental";
  info.description = "a pose graph that comes pose by pose, as it would to a robot";
  info.default_backend = "isam2";
  info.is_stochastic = true;
  using P = GraphIncrementalParams;
  set_graph_task<P>(
      info,
      {{"each", "an update for every pose", {}},
       {"every-10", "an update for every tenth pose", {.poses_per_update = 10}},
       {"calls", "the graph of a system, call by call as it made them", {.use_calls = true}}});
  return info;
}

template <class T>
std::string names_of(const std::vector<T>& items) {
  std::string names;
  for (const T& item : items) names += (names.empty() ? "" : " ") + item.name;
  return names;
}

}  // namespace

bool SystemInfo::has_profile(std::string_view profile) const {
  return std::any_of(profiles.begin(), profiles.end(),
                     [profile](const ProfileInfo& info) { return info.name == profile; });
}

LogSensors sensors_of(const SensorLog& log) {
  return {log.num_wheel_samples() > 0, log.num_imu_samples() > 0};
}

std::optional<std::string> missing_sensor(const SystemInfo& info, const LogSensors& sensors) {
  if (info.needs_wheels && !sensors.has_wheels) return "wheels";
  if (info.needs_imu && !sensors.has_imu) return "an IMU";
  return std::nullopt;
}

std::vector<SystemInfo> systems() {
  return {dead_reckoning_entry(false),
          dead_reckoning_entry(true),
          gmapping_entry(),
          karto_entry(),
          mrpt_icp_entry(),
          mrpt_rbpf_entry(),
          fusion_paper_entry(),
          fusion_entry(),
          graph_batch_entry(),
          graph_incremental_entry()};
}

Result<SystemInfo> find_system(std::string_view name) {
  const std::vector<SystemInfo> all = systems();
  for (const SystemInfo& info : all) {
    if (info.name == name) return info;
  }
  return fail(ErrorCode::kNotFound, fmt::format(R"(unknown system "{}")", name), "",
              "one of: " + names_of(all));
}

Result<SystemChoice> parse_system_choice(std::string_view text) {
  const std::size_t at = text.find('@');
  const std::string_view name = text.substr(0, at);
  const Result<SystemInfo> info = find_system(name);
  if (!info) return tl::make_unexpected(info.error());
  if (at == std::string_view::npos) {
    return SystemChoice{std::string(name), info->profiles.front().name};
  }
  const std::string_view profile = text.substr(at + 1);
  if (!info->has_profile(profile)) {
    return fail(ErrorCode::kNotFound,
                fmt::format(R"(unknown profile "{}" of system {})", profile, name), "",
                "one of: " + names_of(info->profiles));
  }
  return SystemChoice{std::string(name), std::string(profile)};
}

}  // namespace corridor::runner
