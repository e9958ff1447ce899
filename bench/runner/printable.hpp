// Text of others (arguments, names of files, what a file says) as a terminal may get it.
#pragma once

#include <string>
#include <string_view>

namespace corridor::runner {

// UTF-8 as it is; bytes that are no UTF-8 and control characters as \xNN, so that no text can
// move the cursor, change colours or forge a line. Line ends and tabs count as control characters.
std::string printable(std::string_view text);

}  // namespace corridor::runner
