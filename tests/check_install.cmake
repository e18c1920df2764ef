cmake_minimum_required(VERSION 3.23)
# What is installed can be found, compiled and linked by a project that has nothing else of this one, and runs.
# -DROOT= the sources, -DBUILD= a build of them, -DCOMPILER= its compiler, -DFOLDER= where to work.
file(REMOVE_RECURSE "${FOLDER}")
function(run)
  execute_process(COMMAND ${ARGV} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGV}: ${result}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${FOLDER}/prefix")
run("${CMAKE_COMMAND}" -S "${ROOT}/tests/install" -B "${FOLDER}/build" "-DCMAKE_PREFIX_PATH=${FOLDER}/prefix"
  "-DCMAKE_CXX_COMPILER=${COMPILER}")
run("${CMAKE_COMMAND}" --build "${FOLDER}/build")
run("${FOLDER}/build/two_balls")
if(NOT output MATCHES "the balls meet at t = 1 ")
  message(FATAL_ERROR "two_balls says: ${output}")
endif()
