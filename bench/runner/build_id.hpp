// Which build of the program this is: a revision with local changes, or none, names many.
#pragma once

#include <optional>
#include <string>

namespace corridor::runner {

// The head of the SHA-256 of this program's own file; none if it cannot be read.
std::optional<std::string> build_id();

}  // namespace corridor::runner
