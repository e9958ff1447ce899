// The revision this program was built from: "1a2b3c4d5e6f", "+dirty" behind it if files differed
// from it, "unknown" outside git.
#pragma once

#include <string>

namespace corridor::runner {

std::string git_revision();

}  // namespace corridor::runner
