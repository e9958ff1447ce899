// Cases that solve pose graphs in spite of false loop closures, which may have been planted: which
// ones they are, by which method, and which of them count as a success.
#pragma once

#include <string>

#include "reports/cases.hpp"

namespace corridor::reports {

// Found again is what ends with status ok and a chi2 of the true edges within this of the best
// known. A millionth, as for back-ends, would ask for more than a method promises: of the true
// closures 1 % lie beyond the bound by chance. Had each just its 11.3 of three degrees of freedom,
// leaving them out would cost 4 %; one that alone holds a loop costs several times that, and two of
// 216 on a walk cost 10 %. A false one that was kept and nearly fits costs as little (7 to 13 % on
// Intel), which recall shows; one that bends the graph cost 43 % and more there, and what settles
// elsewhere has up to thousands of times the best.
inline constexpr double kFoundAgain_ratio = 0.25;

bool is_found_again(const results::RunResult& result);

// "none", a kernel's name, or that of what rejects closures; empty in records without it.
std::string method_of(const results::RunResult& result);
// Planted, of all closures.
double false_share_of(const results::RunResult& result);

// False closures were planted or a method looked for them; and what the same suite solved with the
// same other parameters but neither, which is their baseline. `graphs` has graph cases only.
Cases with_false_closures(const Cases& graphs);
// The others: a robust method is not to be measured by the optimum without it.
Cases without_false_closures(const Cases& graphs);

}  // namespace corridor::reports
