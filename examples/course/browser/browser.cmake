# Programs of the course compiled once more, to WebAssembly, and put into the pages that they write: there they run anew
# with what somebody drags. Compiled by clang with Debian's C library for wasm32-wasi; scripts/setup installs both.
set(to_try "#include <iostream>\nint main() { std::cout << 1; }\n")
file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/wasm/to_try.cpp" CONTENT "${to_try}" @ONLY)
set(KDS_WASM_CXX "" CACHE FILEPATH "The clang++ that compiles to WebAssembly; else the first that can")
mark_as_advanced(KDS_WASM_CXX)
if(NOT KDS_WASM_CXX)
  foreach(name IN ITEMS clang++ clang++-14 clang++-16 clang++-19)
    find_program(KDS_WASM_CANDIDATE ${name} NO_CACHE)
    if(KDS_WASM_CANDIDATE)
      execute_process(
        COMMAND "${KDS_WASM_CANDIDATE}" --target=wasm32-wasi -std=c++20 to_try.cpp -o to_try.wasm
        WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/wasm" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
      if(failed STREQUAL "0")
        set_property(CACHE KDS_WASM_CXX PROPERTY VALUE "${KDS_WASM_CANDIDATE}")
        break()
      endif()
    endif()
    unset(KDS_WASM_CANDIDATE)
  endforeach()
endif()
if(NOT KDS_WASM_CXX)
  if(NOT KDS_BUILD_WASM STREQUAL "IF_FOUND")
    message(FATAL_ERROR "KDS_BUILD_WASM: no clang++ here compiles and links for wasm32-wasi; set KDS_WASM_CXX")
  endif()
  message(STATUS "Pages of the course are left without their programs: no clang++ here links for wasm32-wasi")
  return()
endif()

# Headers of others that need nothing of the system; a whole /usr/include would bring its C library.
foreach(found IN ITEMS "Boost::headers boost" "Eigen3::Eigen Eigen" "nlohmann_json::nlohmann_json nlohmann")
  separate_arguments(found)
  list(GET found 0 target)
  list(GET found 1 folder)
  get_target_property(includes ${target} INTERFACE_INCLUDE_DIRECTORIES)
  find_path(KDS_WASM_OTHERS ${folder} PATHS ${includes} NO_CACHE NO_DEFAULT_PATH REQUIRED)
  file(MAKE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/wasm/others")
  file(CREATE_LINK "${KDS_WASM_OTHERS}/${folder}" "${CMAKE_CURRENT_BINARY_DIR}/wasm/others/${folder}" SYMBOLIC)
  unset(KDS_WASM_OTHERS)
endforeach()

# Small before fast: a page contains it, and a run of a few elements takes some milliseconds either way.
set(KDS_WASM_COMPILE ${CMAKE_CXX_COMPILER_LAUNCHER} "${KDS_WASM_CXX}" --target=wasm32-wasi -std=c++20 -Oz -DNDEBUG
  -ffp-contract=off -fno-math-errno -ffunction-sections -fdata-sections "-I${PROJECT_SOURCE_DIR}"
  -isystem "${CMAKE_CURRENT_BINARY_DIR}/wasm/others"
  # Of the standard library for wasm32-wasi std::filesystem is left out.
  -DJSON_HAS_FILESYSTEM=0 -DJSON_HAS_EXPERIMENTAL_FILESYSTEM=0
  CACHE INTERNAL "how a file is compiled to WebAssembly")

# kds_wasm_object(SOURCE VARIABLE): compiles a file; the object's path is put into the variable.
function(kds_wasm_object source variable)
  cmake_path(IS_PREFIX PROJECT_BINARY_DIR "${source}" generated)
  if(generated)
    file(RELATIVE_PATH name "${PROJECT_BINARY_DIR}" "${source}")
  else()
    file(RELATIVE_PATH name "${PROJECT_SOURCE_DIR}" "${source}")
  endif()
  string(REPLACE "/" "_" name "${name}")
  set(object "${PROJECT_BINARY_DIR}/examples/course/wasm/${name}.o")
  add_custom_command(OUTPUT "${object}"
    COMMAND ${KDS_WASM_COMPILE} -MD -MF "${object}.d" -MT "${object}" -c "${source}" -o "${object}"
    DEPENDS "${source}" DEPFILE "${object}.d" COMMENT "Compiling ${name} to WebAssembly" VERBATIM)
  set(${variable} "${object}" PARENT_SCOPE)
endfunction()

# What of the library those programs link; what one does not use is left out of it. An object of a source above is that
# of one custom target, so that two programs do not compile it at the same time.
set(of_library kds/large_vector kds/arithmetic/exact kds/roots/failure_time certificates/order
  certificates/plane_certificates collision/broad_phase/tuning collision/broad_phase/unlisted_axes
  collision/broad_phase/kinetic_sweep_and_prune_axes collision/broad_phase/kinetic_sweep_and_prune_queries
  collision/broad_phase/kinetic_sweep_and_prune)
list(TRANSFORM of_library PREPEND "${PROJECT_SOURCE_DIR}/")
list(TRANSFORM of_library APPEND ".cpp")
if(KDS_COMPILE_TOGETHER)
  set(together "${PROJECT_BINARY_DIR}/examples/course/wasm/of_library.cpp")
  list(JOIN of_library "\"\n#include \"" includes)
  # Of the files that define the members of one class template the last one instantiates it.
  file(CONFIGURE OUTPUT "${together}" CONTENT "#define KDS_PARTS_TOGETHER\n#include \"@includes@\"\n" @ONLY)
  set(of_library "${together}")
endif()
set(objects "")
foreach(source IN ITEMS ${of_library} "${PROJECT_SOURCE_DIR}/examples/course/page.cpp"
                        "${PROJECT_SOURCE_DIR}/examples/course/browser/write.cpp"
                        "${PROJECT_SOURCE_DIR}/examples/course/browser/exceptions.cpp")
  kds_wasm_object("${source}" object)
  list(APPEND objects "${object}")
endforeach()
set(KDS_WASM_OBJECTS "${objects}" CACHE INTERNAL "what all programs in pages link")
add_custom_target(kds_wasm_objects DEPENDS ${KDS_WASM_OBJECTS})

# kds_runs_in_its_page(TARGET SOURCE): the program once more, in the pages that it writes.
function(kds_runs_in_its_page target source)
  kds_wasm_object("${source}" object)
  set(wasm "${PROJECT_BINARY_DIR}/examples/course/wasm/${target}.wasm")
  add_custom_command(OUTPUT "${wasm}.cpp"
    COMMAND "${KDS_WASM_CXX}" --target=wasm32-wasi -Wl,--gc-sections,--strip-all "${object}" ${KDS_WASM_OBJECTS}
            -o "${wasm}"
    COMMAND "${CMAKE_COMMAND}" "-DWASM=${wasm}" -P "${PROJECT_SOURCE_DIR}/examples/course/browser/embed.cmake"
    DEPENDS "${object}" kds_wasm_objects ${KDS_WASM_OBJECTS} "${PROJECT_SOURCE_DIR}/examples/course/browser/embed.cmake"
    BYPRODUCTS "${wasm}" COMMENT "Linking ${target}.wasm" VERBATIM)
  target_sources(${target} PRIVATE "${wasm}.cpp")
  set_target_properties(${target} PROPERTIES KDS_IN_ITS_PAGE ON)
endfunction()
