#include "reports/html/claim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "reports/html/standing.hpp"
#include "reports/metrics.hpp"
#include "reports/published.hpp"
#include "reports/tables/paper_world.hpp"

namespace corridor::html {
namespace {

using reports::Cases;
using reports::PublishedError;
using reports::Series;
using tables::Metric;

constexpr const char* kMethod = "fusion-paper";
constexpr const char* kRival = "karto";
// The published method with the one part exchanged that costs it its heading.
constexpr const char* kWithHeading = "with-directions";

const PublishedError& published(const char* system) {
  return *std::find_if(reports::kPaperTable2.begin(), reports::kPaperTable2.end(),
                       [&](const PublishedError& error) { return error.system == system; });
}

std::optional<Series> counterpart(const Cases& cases, const std::string& dataset,
                                  const char* system) {
  for (const Series& series : cases.series()) {
    if (series.system == system && tables::is_paper_counterpart(cases, series) &&
        !cases.of(dataset, series).empty()) {
      return series;
    }
  }
  return std::nullopt;
}

// "reduces karto's angle error by 12.0 % [-3.1, 24.0] (n = 30)".
std::string reduction_text(const statistics::Estimate& ratio, const Metric& metric) {
  return fmt::format("reduces {}'s {} by {:.1f} % [{:.1f}, {:.1f}] (n = {})", kRival, metric.name,
                     100 * (1 - ratio.value), 100 * (1 - ratio.high), 100 * (1 - ratio.low),
                     ratio.num_values);
}

const char* verdict_on(const statistics::Estimate& ratio, double claimed_ratio) {
  if (ratio.high <= claimed_ratio) return "the whole interval is beyond it.";
  if (ratio.low > claimed_ratio) return "not reached here.";
  return ratio.value <= claimed_ratio ? "the median is beyond it, the interval is not."
                                      : "not reached here by the median, but within the interval.";
}

// Where a heading is lost that the LiDAR saw.
std::string why_angle(const Cases& cases, const std::string& dataset, const Series& rival) {
  const Metric metric = reports::angle_error();
  std::string text;
  const tables::Cell of_rival = tables::summarise(cases, dataset, rival, metric);
  if (const auto* estimate = std::get_if<tables::Estimate>(&of_rival)) {
    text += fmt::format(" {}'s own angle error is {} here and {:.3f} deg in the paper.", kRival,
                        with_unit(*estimate, metric.unit), published(kRival).angle_deg);
  }
  text +=
      " Where consecutive scans hardly differ the method leaves the LiDAR out as a whole, with the "
      "heading that the walls give, and drives on with the gyro's.";
  for (const Series& series : cases.series()) {
    if (series.system != kMethod || series.profile != kWithHeading || !series.overrides.empty()) {
      continue;
    }
    const auto ratio = tables::compare_worlds(tables::world_values(cases, dataset, rival, metric),
                                              tables::world_values(cases, dataset, series, metric));
    if (ratio) {
      text += fmt::format(" Leaving out only the direction that is not seen ({}) it {}.",
                          cases.label(series), reduction_text(*ratio, metric));
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> claim_sentences(const Cases& cases, const std::string& dataset) {
  if (!tables::is_paper_world(cases, dataset)) return {};
  const auto method = counterpart(cases, dataset, kMethod);
  const auto rival = counterpart(cases, dataset, kRival);
  if (!method || !rival) return {};
  std::vector<std::string> sentences;
  for (const bool is_position : {true, false}) {
    const Metric metric = is_position ? reports::position_error() : reports::angle_error();
    const auto ratio =
        tables::compare_worlds(tables::world_values(cases, dataset, *rival, metric),
                               tables::world_values(cases, dataset, *method, metric));
    if (!ratio) continue;
    const double claimed_ratio = is_position
                                     ? published(kMethod).position_m / published(kRival).position_m
                                     : published(kMethod).angle_deg / published(kRival).angle_deg;
    std::string sentence =
        fmt::format("The published method ({}) {}; the paper claims {:.2f} %: {}", kMethod,
                    reduction_text(*ratio, metric), 100 * (1 - claimed_ratio),
                    verdict_on(*ratio, claimed_ratio));
    if (!is_position && ratio->value > claimed_ratio) sentence += why_angle(cases, dataset, *rival);
    sentences.push_back(std::move(sentence));
  }
  return sentences;
}

}  // namespace corridor::html
