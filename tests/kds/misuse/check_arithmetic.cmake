# Options under which signs are not exact are refused by every header that calculates, with a reason.
function(expect_refusal options)
  foreach(header IN ITEMS arithmetic/double_double arithmetic/exact arithmetic/lattice arithmetic/unrolled
          simd/two_doubles simd/four_doubles simd/four_floats)
    separate_arguments(list UNIX_COMMAND "${options}")
    file(WRITE "${FOLDER}/uses_header.cpp" "#include \"kds/${header}.hpp\"\n")
    # Refusals are there before anything is compiled.
    if(options STREQUAL "")
      set(until -fsyntax-only)
    else()
      set(until -E -o /dev/null)
    endif()
    execute_process(COMMAND "${COMPILER}" -std=c++20 -O2 ${list} ${until} "-I${ROOT}" "${FOLDER}/uses_header.cpp"
                    RESULT_VARIABLE failed ERROR_VARIABLE said OUTPUT_VARIABLE said)
    string(FIND "${said}" "kds: compile" found)
    if(NOT options STREQUAL "" AND (NOT failed OR found EQUAL -1))
      message(SEND_ERROR "${header}.hpp compiles with ${options}, or without a word on why not:\n${said}")
    elseif(options STREQUAL "" AND failed)
      message(SEND_ERROR "${header}.hpp does not compile:\n${said}")
    endif()
  endforeach()
endfunction()

expect_refusal("")
expect_refusal("-ffast-math")
expect_refusal("-ffinite-math-only")
if(ID STREQUAL "GNU")  # clang has no macro for these
  expect_refusal("-funsafe-math-optimizations")
  expect_refusal("-fassociative-math -fno-signed-zeros -fno-trapping-math")
  expect_refusal("-freciprocal-math")
  if(PROCESSOR MATCHES "^(x86_64|AMD64)$")
    expect_refusal("-mfpmath=387")
  endif()
endif()

# What no macro tells of is seen when a program runs.
function(expect_throw options expected)
  separate_arguments(list UNIX_COMMAND "${options}")
  file(WRITE "${FOLDER}/asks.cpp" "#include \"kds/arithmetic/strict.hpp\"
#include <cstdio>
int main() {
  try { kds::require_strict_arithmetic(\"asks\"); } catch (const std::exception& error) { std::puts(error.what()); }
}
")
  execute_process(COMMAND "${COMPILER}" -std=c++20 -O2 ${list} "-I${ROOT}" "${FOLDER}/asks.cpp" -o "${FOLDER}/asks"
                  COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND "${FOLDER}/asks" OUTPUT_VARIABLE said RESULT_VARIABLE failed)
  if(failed OR NOT said MATCHES "^${expected}")
    message(SEND_ERROR "Compiled with \"${options}\" it says \"${said}\" and not \"${expected}\" (${failed})")
  endif()
endfunction()
expect_throw("-ffp-contract=off" "$")
expect_throw("-ffp-contract=off -O0" "$")
expect_throw("-ffp-contract=off -O3" "$")
if(ID STREQUAL "Clang")
  expect_throw("-ffp-contract=off -fassociative-math -fno-signed-zeros" "asks: it is compiled with options that change")
  if(PROCESSOR MATCHES "^(x86_64|AMD64)$")  # where linking with this option, too, changes the mode of the processor
    expect_throw("-ffp-contract=off -funsafe-math-optimizations" "asks: this thread takes subnormal numbers for zero")
  endif()
endif()
if(HAS_FMA)
  expect_throw("-ffp-contract=off -mfma -O3" "$")
  expect_throw("-ffp-contract=fast -mfma -O3" "asks: it is compiled with fused multiply-add")
endif()
