// The published method against what its paper claims of it, as sentences: by how much it reduces
// karto's errors, in the paper and here, and where the difference comes from.
#pragma once

#include <string>
#include <vector>

#include "reports/cases.hpp"

namespace corridor::html {

// None where the data set is not the paper's corridor, or fusion-paper or karto were not run as the
// paper's counterparts on enough worlds for an interval.
std::vector<std::string> claim_sentences(const reports::Cases& cases, const std::string& dataset);

}  // namespace corridor::html
