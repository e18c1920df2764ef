cmake_minimum_required(VERSION 3.23)
# The same file has worlds of degrees that there are, and of others, of which each is refused, and two of motions for
# which the library is not compiled, or not without another library. To read what a world includes is most of the time,
# so that is done once without splines and once with them.
list(TRANSFORM INCLUDES PREPEND -I)
set(of_degree "World: bodies move on lines \\(degree 1\\) or parabolas \\(degree 2\\)")
set(of_motion "World: no world of bodies with this type of motion is compiled in the library")
function(expect_refused refused degrees)  # and options of the compiler
  execute_process(
    COMMAND "${COMPILER}" -std=c++20 -fsyntax-only -w "-DDEGREES=${degrees}" ${ARGN} "-I${ROOT}" ${INCLUDES}
            "${ROOT}/tests/collision/misuse/world_of_degree.cc"
    RESULT_VARIABLE failed ERROR_VARIABLE said OUTPUT_VARIABLE said)
  string(REGEX MATCHALL "error: static[_ ]assert[^\n]*${of_degree}" by_degree "${said}")
  string(REGEX MATCHALL "error: static[_ ]assert[^\n]*${of_motion}" by_motion "${said}")
  string(REGEX MATCHALL " error: " errors "${said}")
  list(LENGTH by_degree times)
  list(LENGTH by_motion motions)
  list(LENGTH errors all)
  math(EXPR expected "${refused} + 2")
  if(NOT failed OR NOT times EQUAL refused OR NOT motions EQUAL 2 OR NOT all EQUAL expected)
    message(FATAL_ERROR "Of the worlds of degrees ${degrees} ${ARGN} ${times} are refused for their degree, where "
                        "${refused} should be, ${motions} for their motion, where 2 should be, and there are ${all} "
                        "errors:\n${said}")
  endif()
endfunction()
expect_refused(2 "1,2,0,3")
expect_refused(2 "1,5,0,6" -DKDS_SPLINES)
