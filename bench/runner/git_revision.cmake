# Writes OUTPUT, a source file with the revision of SOURCE_DIR, and touches it only if it changed.
# Run at every build, since a revision that is asked for when configuring is soon a wrong one.
set(revision "unknown")
find_program(GIT_PROGRAM git)
if(GIT_PROGRAM)
  execute_process(COMMAND ${GIT_PROGRAM} rev-parse --short=12 HEAD
    WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE head RESULT_VARIABLE code
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(code EQUAL 0)
    set(revision "${head}")
    execute_process(COMMAND ${GIT_PROGRAM} status --porcelain --untracked-files=normal
      WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE changes ERROR_QUIET)
    if(NOT changes STREQUAL "")
      string(APPEND revision "+dirty")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
[[#include "bench/runner/git_revision.hpp"

namespace corridor::runner {

std::string git_revision() { return "@revision@"; }

}  // namespace corridor::runner
]] @ONLY)
