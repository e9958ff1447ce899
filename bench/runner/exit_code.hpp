// Exit codes of the program.
#pragma once

namespace corridor::runner {

inline constexpr int kExitDone = 0;
inline constexpr int kExitNo = 1;  // ran, but the answer is no: a case failed, a file differs
inline constexpr int kExitBadRequest = 2;  // the request or its input was wrong
// Of `run-case` only, so that `run` can tell it from a wrong request.
inline constexpr int kExitOutOfMemory = 3;
inline constexpr int kExitNotWritten = 4;  // the case ran, its results cannot be written

}  // namespace corridor::runner
