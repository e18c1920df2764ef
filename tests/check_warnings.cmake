cmake_minimum_required(VERSION 3.23)
# Users include our headers in files that they compile with their own warnings: none comes from ours, nor from the
# example of the README. HEADERS is a file that includes all of them, SYSTEM the folders of other libraries.
set(warnings -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wsign-conversion)
list(TRANSFORM SYSTEM PREPEND -idirafter)
execute_process(COMMAND "${COMPILER}" -std=c++20 -fsyntax-only ${warnings} "-I${ROOT}" ${SYSTEM} "${HEADERS}"
                "${ROOT}/examples/00_two_balls.cpp" RESULT_VARIABLE failed ERROR_VARIABLE said OUTPUT_VARIABLE said)
if(failed OR said MATCHES "warning")
  message(FATAL_ERROR "${COMPILER} ${warnings} says:\n${said}")
endif()
