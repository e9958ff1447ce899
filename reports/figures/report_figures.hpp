// The figures of a report, each made from all cases and the files they left.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/cases.hpp"
#include "reports/figures/svg.hpp"

namespace corridor::figures {

struct Figure {
  Svg svg;
  std::string caption;
};

// The world in which one rival has its median position error, and why: what single-world figures
// show.
struct Representative {
  reports::World world;
  std::string reason;
};
// nullopt for a data set without true poses.
std::optional<Representative> representative_world(const reports::Cases& cases,
                                                   const std::string& dataset);
// The case of a series in a world: the one with the smallest system seed; nullptr without one.
const reports::Case* case_in_world(const reports::Cases& cases, const reports::World& world,
                                   const reports::Series& series);

// Key distances a, b, c and alpha in the drawing of the corridor, as in the paper's figure 3 b.
std::optional<Figure> environment_figure(const reports::Cases& cases, const std::string& dataset,
                                         std::vector<std::string>& problems);
// All final trajectories against the truth in the representative world.
std::optional<Figure> trajectory_figure(const reports::Cases& cases, const std::string& dataset,
                                        std::vector<std::string>& problems);
// Maps side by side: simulated data with the true walls over the maps of GMapping, Karto and the
// fusion systems; recorded data with every system's map.
std::optional<Figure> map_figure(const reports::Cases& cases, const std::string& dataset,
                                 std::vector<std::string>& problems);
// Every world's position and angle error per system on logarithmic axes.
std::optional<Figure> error_figure(const reports::Cases& cases, const std::string& dataset);
// "corridor-range" of "corridor-range@4.5", the member of a family; empty for other data sets.
std::string family_of(const std::string& dataset);
// Position and angle error over the values of a family of scenarios, a line per system, with the
// Cramer-Rao bound; nullopt with fewer than two values.
std::optional<Figure> sweep_figure(const reports::Cases& logs, const std::string& family);
// Share of problems that each back-end of a system that solves graphs solves within a factor of the
// fastest time; `graphs` has graph cases only, here and below.
std::optional<Figure> profile_figure(const reports::Cases& graphs, const std::string& system);
// How often a graph was solved over the noise on its start, a line per back-end; nullopt where
// nothing started from noise on headings.
std::optional<Figure> initial_noise_figure(const reports::Cases& graphs);
// How often a graph was found again over the share of false closures, a line per method; of cases
// with_false_closures() and one back-end.
std::optional<Figure> false_closure_figure(const reports::Cases& cases, const std::string& backend);
// Time of an update over the number of poses.
std::optional<Figure> update_figure(const reports::Cases& graphs, const std::string& dataset,
                                    std::vector<std::string>& problems);
// Gap to the batch optimum along the run.
std::optional<Figure> gap_figure(const reports::Cases& graphs, const std::string& dataset,
                                 std::vector<std::string>& problems);
// Time of a step and of each stage: median, 95 % quantile, maximum, and the share of all time.
std::optional<Figure> stage_figure(const reports::Cases& cases, const std::string& dataset);

// All of the above for every data set, in the order of the page.
std::vector<Figure> report_figures(const reports::Cases& cases, std::vector<std::string>& problems);

}  // namespace corridor::figures
