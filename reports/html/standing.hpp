// How one series stands against every other one in one number, as a sentence. It claims no more
// than the paired intervals show, and names those that it could not be compared with.
#pragma once

#include <string>
#include <vector>

#include "reports/cases.hpp"
#include "reports/tables/summary.hpp"

namespace corridor::html {

struct Entry {
  reports::Series series;
  std::string label;
  tables::WorldValues values;
  tables::Estimate estimate;
};

// The series with a value of the metric on the data set, the smallest median first.
std::vector<Entry> entries_by_median(const reports::Cases& cases, const std::string& dataset,
                                     const tables::Metric& metric);

// "0.022 m [0.016, 0.033]".
std::string with_unit(const tables::Estimate& estimate, const std::string& unit);

// "The position error of A is 0.1 m [0.08, 0.15] (n = 20 of 20 worlds, the smallest median of 3).
// It is shown to be smaller than that of all 2 others, closest B: ratio 0.23 [0.17, 0.38], n = 20."
// What is not shown to differ, what is smaller and what could not be compared is named likewise.
// Requires index < entries.size().
std::string standing(const tables::Metric& metric, const std::vector<Entry>& entries,
                     std::size_t index);

}  // namespace corridor::html
