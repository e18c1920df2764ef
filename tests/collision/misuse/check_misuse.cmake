cmake_minimum_required(VERSION 3.23)
# The same file has worlds of degrees that there are, and of others, of which each is refused, and no more. To read what
# a world includes is most of the time, so that is done once without splines and once with them.
list(TRANSFORM INCLUDES PREPEND -I)
set(reason "World: bodies move on lines \\(degree 1\\) or parabolas \\(degree 2\\)")
function(expect_refused refused degrees)  # and options of the compiler
  execute_process(
    COMMAND "${COMPILER}" -std=c++20 -fsyntax-only -w "-DDEGREES=${degrees}" ${ARGN} "-I${ROOT}" ${INCLUDES}
            "${ROOT}/tests/collision/misuse/world_of_degree.cc"
    RESULT_VARIABLE failed ERROR_VARIABLE said OUTPUT_VARIABLE said)
  string(REGEX MATCHALL "error: static[_ ]assert[^\n]*${reason}" named "${said}")
  list(LENGTH named times)
  string(REGEX MATCHALL " error: " errors "${said}")
  list(LENGTH errors all)
  if(NOT failed OR NOT times EQUAL refused OR NOT all EQUAL refused)
    message(FATAL_ERROR "${times} of the worlds of degrees ${degrees} ${ARGN} are refused with a reason, and there are "
                        "${all} errors, where ${refused} of each should be:\n${said}")
  endif()
endfunction()
expect_refused(2 "1,2,0,3")
expect_refused(2 "1,5,0,6" -DKDS_SPLINES)
