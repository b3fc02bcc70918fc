# Writes OUTPUT, which says which commit SOURCE_DIR is at; rewritten only when that changes.
#
#   cmake -D SOURCE_DIR=... -D OUTPUT=... -P write_build_source.cmake

set(commit "")
set(is_clean false)
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} rev-parse HEAD
    OUTPUT_VARIABLE commit RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(failed)
    set(commit "")
  else()
    # Published results may differ: publishing one experiment must not keep the next from it.
    set(aside ":(exclude)notebooks-data" ":(exclude)paper-figures/data")
    execute_process(
      COMMAND ${GIT} -C ${SOURCE_DIR} diff --quiet HEAD -- . ${aside}
      RESULT_VARIABLE differs ERROR_QUIET)
    execute_process(
      COMMAND ${GIT} -C ${SOURCE_DIR} ls-files --others --exclude-standard -- . ${aside}
      OUTPUT_VARIABLE untracked ERROR_QUIET)
    if(NOT differs AND untracked STREQUAL "")
      set(is_clean true)
    endif()
  endif()
endif()

set(text "#pragma once

// Made by CMake at every build: what this library is built from.
namespace graspfit::sweep {

inline constexpr const char* kBuildCommit = \"${commit}\";
inline constexpr bool kIsBuildClean = ${is_clean};

}  // namespace graspfit::sweep
")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
