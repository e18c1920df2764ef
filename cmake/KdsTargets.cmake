# kds_optimise(TARGET): a library in which tests run for minutes is compiled with -O2 by presets with tests too, whose
# flags are -O1: with that replays and random worlds take two to three times as long, and files of tests, which are most
# of the build, a quarter less to compile.
function(kds_optimise target)
  if(NOT KDS_BUILD_TESTS)
    return()
  endif()
  target_compile_options(${target} PRIVATE
    $<$<AND:$<CONFIG:RelWithDebInfo>,$<CXX_COMPILER_ID:GNU,Clang,AppleClang>>:-O2>)
endfunction()

# kds_add_layer(NAME [LINK target...] [EXCLUDE name...]): the library of one layer, from the files of its folder but
# those of the names to exclude.
# A folder without .cpp files gives an INTERFACE library, so that a layer may begin as headers and grow sources.
function(kds_add_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "LINK;EXCLUDE")
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.hpp")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")

  foreach(excluded IN LISTS ARG_EXCLUDE)
    list(FILTER headers EXCLUDE REGEX "/${excluded}\\.hpp$")
    list(FILTER sources EXCLUDE REGEX "/${excluded}\\.cpp$")
  endforeach()

  set(target kds_${name})
  if(name STREQUAL "kds")
    set(target kds)
  endif()

  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:kds_warnings>)
    kds_optimise(${target})
    # Numbers of 64 bits, ids of bodies say, that are taken for ones of 32.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wconversion>
                                             $<$<CXX_COMPILER_ID:Clang,AppleClang>:-Wshorten-64-to-32>)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(kds::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})

  target_sources(${target} ${scope}
    FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${headers})
  target_link_libraries(${target} ${scope} ${ARG_LINK})
  set_property(GLOBAL APPEND PROPERTY KDS_LAYER_TARGETS ${target})
endfunction()

# Our warnings, for our own files only: users of the library do not inherit them.
add_library(kds_warnings INTERFACE)
target_compile_options(kds_warnings INTERFACE
  $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-Wall;-Wextra;-Wpedantic>
  # Designated initialisers leave members out on purpose.
  $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-Wno-missing-field-initializers>
  # g++ 12 warns of overlapping copies in its own std::string (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)

# kds_compile_together(target FILES): the files of a target, so many at a time, as one: what they include and
# instantiate in common is compiled once, which is most of the time. scripts/test-apart does without, so that a file that
# does not include what it needs, or uses a name of another file's, is seen there.
option(KDS_COMPILE_TOGETHER "Compile several files as one: a third of the time" ON)
function(kds_compile_together target files)
  if(KDS_COMPILE_TOGETHER)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
    # Such a file looks like a header to g++ 12, and its own headers of vector instructions uninitialised.
    target_compile_options(${target} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage$<SEMICOLON>-Wno-maybe-uninitialized>)
  endif()
endfunction()

# kds_read_headers_once(target...): in a build with tests, the headers of others that are half of most files are
# compiled once for all these targets, and read as they were compiled. Not our own: whoever changes one waits for what
# includes it only. Nor for libraries that are linked into the Python module, whose code is compiled otherwise. g++
# takes the level of optimisation from the precompiled headers, whatever a target says: so no target says another one.
function(kds_read_headers_once)
  if(NOT KDS_COMPILE_TOGETHER OR NOT KDS_BUILD_TESTS)
    return()
  endif()
  if(NOT TARGET kds_headers_of_others)
    find_package(Catch2 2.13 REQUIRED)
    set(source "${PROJECT_BINARY_DIR}/headers_of_others.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "")
    add_library(kds_headers_of_others OBJECT "${source}")
    target_link_libraries(kds_headers_of_others PRIVATE kds::collision kds_warnings Catch2::Catch2)
    target_precompile_headers(kds_headers_of_others PRIVATE
      <catch2/catch.hpp> <Eigen/Core> <Eigen/Geometry> <boost/heap/d_ary_heap.hpp> <boost/multiprecision/cpp_int.hpp>)
  endif()
  foreach(target IN LISTS ARGN)
    target_precompile_headers(${target} REUSE_FROM kds_headers_of_others)
  endforeach()
endfunction()
