# Another clang-format formats otherwise, so only version 14 (Debian 12) decides.
find_program(clang_format NAMES clang-format-14 clang-format)
if(NOT clang_format)
  message("SKIPPED: no clang-format")
  return()
endif()
execute_process(COMMAND ${clang_format} --version OUTPUT_VARIABLE version)
if(NOT version MATCHES "version 14\\.")
  string(STRIP "${version}" version)
  message("SKIPPED: the format is that of clang-format 14, here is ${version}")
  return()
endif()

set(sources "")
foreach(folder IN ITEMS base geometry hands grasp viewer app experiments tests)
  file(GLOB_RECURSE found ${SOURCE_DIR}/${folder}/*.hpp ${SOURCE_DIR}/${folder}/*.cpp)
  list(APPEND sources ${found})
endforeach()
execute_process(
  COMMAND ${clang_format} --dry-run --Werror --style=file ${sources}
  RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "Not formatted; clang-format -i <file> does it")
endif()
