// Whether a data set is the paper's corridor: only then do the paper's figures stand beside ours.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "reports/cases.hpp"
#include "reports/metrics.hpp"

namespace corridor::tables {

// The true values of a key distance over all cases of a data set.
std::set<double> true_values(const reports::Cases& cases, const std::string& dataset,
                             reports::KeyVariable variable);
// All four key distances are the paper's in every world, and the suite itself simulated it: a log
// of one's own has no data seed, whatever lies beside it.
bool is_paper_world(const reports::Cases& cases, const std::string& dataset);
// The paper's figures stand beside the profile of a system that comes first in reports (as
// shipped), not beside variants of it, nor where a parameter was set by hand; beside none where
// that profile ran with several sets of parameters of which no record says which was as shipped.
bool is_paper_counterpart(const reports::Cases& cases, const reports::Series& series);
// Whether the paper's figures of a system may have a column: it was not run, or one of its series
// is their counterpart.
bool may_stand_beside_paper(const reports::Cases& cases, std::string_view system);

}  // namespace corridor::tables
