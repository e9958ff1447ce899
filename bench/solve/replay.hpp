// The incremental run: a back-end is told one step after the other, and each is measured.
#pragma once

#include <string>

#include "bench/solve/solve_graph.hpp"
#include "bench/solve/steps.hpp"
#include "slam/core/result.hpp"

namespace corridor::solve {

// What a status does not say; empty for nothing.
std::string message_of(const backend::BackEndReport& report);

// Adds what a report counts, and takes its status over.
void count(const backend::BackEndReport& report, SolveRun& run);

// Steps until an update fails (one that has not converged goes on), then options.do_converge. The
// Error is that of a back-end that does not marginalise.
Result<void> replay(const Steps& steps, backend::BackEnd& back_end, const SolveOptions& options,
                    SolveRun& run);

}  // namespace corridor::solve
