// Readable names of series, as short as they can be while no two are the same.
// It knows the cases' records only: which parameter is a default is the systems' knowledge.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "reports/cases.hpp"

namespace corridor::reports {

// The system's name; "@profile" and "/backend" where the system ran with more than one; then in
// brackets what else tells series of that name apart: up to two parameters with their values (a
// hash of all where more differ), and the code's revision. "karto@as-shipped (a=1, b=2)",
// "fusion (#88adda; at 48762d9+dirty)". What was set by hand always stands there, also where no
// other series has that name: "karto (set: use_loop_closing=false)".
std::map<Series, std::string> series_labels(const std::vector<Case>& cases);

// The keys whose values are not the same in all; a key that one of them lacks is among them.
std::set<std::string> differing_keys(const std::vector<std::map<std::string, std::string>>& all);

}  // namespace corridor::reports
