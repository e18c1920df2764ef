cmake_minimum_required(VERSION 3.23)
# What is installed can be found, compiled and linked by a project that has nothing else of this one, and runs; and
# nobody who does not ask for kds::gsl hears of it.
# -DROOT= the sources, -DBUILD= a build of them, -DCOMPILER= its compiler, -DFOLDER= where to work, -DGSL= whether there
# is a kds::gsl.
file(REMOVE_RECURSE "${FOLDER}")
function(run)
  execute_process(COMMAND ${ARGV} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGV}: ${result}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()
set(configure "${CMAKE_COMMAND}" -S "${ROOT}/tests/install" "-DCMAKE_PREFIX_PATH=${FOLDER}/prefix"
  "-DCMAKE_CXX_COMPILER=${COMPILER}")

run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${FOLDER}/prefix")
# What is not installed is not needed: a build of the library and the tool alone can be installed.
file(GLOB_RECURSE of_gsl "${FOLDER}/prefix/*gsl*" "${FOLDER}/prefix/*Gsl*")
if(of_gsl)
  message(FATAL_ERROR "Installed though nobody has asked for the component gsl: ${of_gsl}")
endif()
run(${configure} -B "${FOLDER}/build" -DCMAKE_DISABLE_FIND_PACKAGE_GSL=ON)
run("${CMAKE_COMMAND}" --build "${FOLDER}/build")
run("${FOLDER}/build/two_balls")
if(NOT output MATCHES "the balls meet at t = 1 ")
  message(FATAL_ERROR "two_balls says: ${output}")
endif()

run(${configure} -B "${FOLDER}/build_io" -DCOMPONENT=io)
run("${CMAKE_COMMAND}" --build "${FOLDER}/build_io" --target scene_run)
run("${FOLDER}/build_io/scene_run")
if(NOT output MATCHES "1 contact, and a record of [0-9][0-9][0-9]+ bytes")
  message(FATAL_ERROR "scene_run says: ${output}")
endif()

# The same by pkg-config, and from the Debian package as it is unpacked.
find_program(pkg_config pkg-config)
if(pkg_config)
  file(GLOB_RECURSE packages "${FOLDER}/prefix/*/kds.pc")
  cmake_path(GET packages PARENT_PATH packages)
  set(ENV{PKG_CONFIG_PATH} "${packages}")
  run("${pkg_config}" --cflags --libs kds)
  separate_arguments(flags UNIX_COMMAND "${output}")
  run("${COMPILER}" "${ROOT}/examples/00_two_balls.cpp" ${flags} -o "${FOLDER}/by_pkg_config")
  run("${FOLDER}/by_pkg_config")
  if(NOT output MATCHES "the balls meet at t = 1 ")
    message(FATAL_ERROR "two_balls, found by pkg-config, says: ${output}")
  endif()
endif()
find_program(dpkg_deb dpkg-deb)
if(dpkg_deb)
  run("${CMAKE_CPACK_COMMAND}" --config "${BUILD}/CPackConfig.cmake" -B "${FOLDER}/packages" -D CPACK_COMPONENTS_ALL=kds
    -D CPACK_DEBIAN_COMPRESSION_TYPE=none)
  file(GLOB package "${FOLDER}/packages/libkds-dev_*.deb")
  run("${dpkg_deb}" --extract "${package}" "${FOLDER}/unpacked")
  run("${CMAKE_COMMAND}" -S "${ROOT}/tests/install" "-DCMAKE_PREFIX_PATH=${FOLDER}/unpacked/usr"
    "-DCMAKE_CXX_COMPILER=${COMPILER}" -B "${FOLDER}/build_of_package")
  run("${CMAKE_COMMAND}" --build "${FOLDER}/build_of_package")
  run("${FOLDER}/build_of_package/two_balls")
endif()

# A component that is not there is refused where it is required, and only there.
execute_process(COMMAND ${configure} -B "${FOLDER}/refused" -DCOMPONENT=gsl
  OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
if(result EQUAL 0 OR NOT output MATCHES "without its component gsl")
  message(FATAL_ERROR "The component gsl is not installed, and yet (${result}):\n${output}")
endif()
run(${configure} -B "${FOLDER}/optional" -DCOMPONENT=gsl -DOPTIONAL=ON)
if(NOT output MATCHES "gsl found: FALSE")
  message(FATAL_ERROR "The component gsl is not installed, and yet:\n${output}")
endif()
if(NOT GSL)
  return()
endif()

run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${FOLDER}/prefix" --component gsl)
run(${configure} -B "${FOLDER}/build_gsl" -DCOMPONENT=gsl)
run("${CMAKE_COMMAND}" --build "${FOLDER}/build_gsl" --target gsl_roots)
run("${FOLDER}/build_gsl/gsl_roots")
if(NOT output MATCHES "fails at t = 1")
  message(FATAL_ERROR "gsl_roots says: ${output}")
endif()
