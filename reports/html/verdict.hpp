// What the numbers say, in sentences: every one computed from the cases, none written in advance.
#pragma once

#include <string>
#include <vector>

#include "reports/cases.hpp"

namespace corridor::html {

struct Verdict {
  std::string subject;  // a data set, or "All cases"
  std::vector<std::string> sentences;
  std::vector<std::string> details;  // the same for everybody else, for those who ask
};

// Per data set: how the most accurate series and the floor (wheels and gyro) stand against every
// other one, and whose maps are too short or too long; in the details the fusion systems and every
// map. Per pose graph who solved it and who in the least time, and what
// found it again with half of its closures false. At the end which cases failed. Plain
// text, to be escaped.
std::vector<Verdict> verdicts(const reports::Cases& cases);

}  // namespace corridor::html
