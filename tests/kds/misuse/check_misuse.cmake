list(TRANSFORM INCLUDES PREPEND -I)
set(all_errors "")
if(COMPILER MATCHES "clang")
  set(all_errors -ferror-limit=0)
endif()

# said_of(FILE message...): the file must not compile, and the compiler must give these messages. Sets `said`.
function(said_of file)
  execute_process(
    COMMAND "${COMPILER}" -std=c++20 -fsyntax-only -w ${all_errors} "-I${ROOT}" ${INCLUDES}
            "${ROOT}/tests/kds/misuse/${file}"
    RESULT_VARIABLE failed ERROR_VARIABLE said OUTPUT_VARIABLE said)
  if(NOT failed)
    message(FATAL_ERROR "${file}, in which each part is wrong, has compiled.")
  endif()
  foreach(expected IN LISTS ARGN)
    string(FIND "${said}" "${expected}" found)
    if(found EQUAL -1)
      message(FATAL_ERROR "${file}: the compiler does not say \"${expected}\", but:\n${said}")
    endif()
  endforeach()
  set(said "${said}" PARENT_SCOPE)
endfunction()

said_of(broken_rules.cc
  "must name what moves" "name = ...;` is missing" "must give a certificate" "must give a range of ids"
  "repair(Slot, Repair<Element>&)` is missing" "remove(Id, Repair<Element>&)` are missing"
  "is missing, which a rule with `keeps` must have" "the solver is no FailureTimeSolver" "a type without archive()"
  "`change` must be" "`keeps` must be" "`build` must be" "`audit` must be" "to be saved it needs"
  "`after_turn` must be" "`sampled` must be" "`moves` must be"
  "certificate: `static constexpr int degree` is missing" "is missing, or does not take every Number"
  "certificate: `degree` is not the degree of its polynomial" "has no `Change`, and so tells nothing"
  "Inner::Change>, Repair<Element>&)` is missing" "changes_from_nothing() const` is missing"
  "`followed` must be" "does not report the change that `Telling` names" "found for certificates of degree 31 at most")
string(REGEX MATCH "[^\n]*static assertion failed: KineticRule<(Base|KeepsAndChanges)>[^\n]*" whole_is_broken "${said}")
if(whole_is_broken)
  message(FATAL_ERROR "A rule from which nothing is missing is refused:\n${said}")
endif()

said_of(temporary_motions.cc)
string(REGEX MATCHALL "temporary_motions.cc:[0-9]+:[0-9]+: error:" named "${said}")
list(REMOVE_DUPLICATES named)
list(LENGTH named times)
if(NOT times EQUAL 11)
  message(FATAL_ERROR "${times} certificates of temporaries are refused, where 11 are made:\n${said}")
endif()

# hooks_are_named(FILE hook...): each is named once, of the certificate in which it is wrong.
function(hooks_are_named file)
  list(TRANSFORM ARGN REPLACE "(.+)" "certificate: `\\1` must be" OUTPUT_VARIABLE messages)
  said_of(${file} ${messages})
  string(REGEX MATCHALL "static[_ ]assert[^\n]*failed[^\n]*certificate: `[a-z_]+` must be" named "${said}")
  list(LENGTH named times)
  list(LENGTH ARGN expected_times)
  if(NOT times EQUAL expected_times)
    message(FATAL_ERROR "${file}: ${times} hooks are named, where ${expected_times} are wrong:\n${said}")
  endif()
endfunction()
hooks_are_named(broken_hooks.cc
  vanishes extended_value quick_failure_time quick_failure_time_after_turn quick_failure_times is_negative_of)
hooks_are_named(broken_turning_hooks.cc quick_value extended_value)
