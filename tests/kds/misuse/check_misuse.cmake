list(TRANSFORM INCLUDES PREPEND -I)
execute_process(COMMAND "${COMPILER}" -std=c++20 -fsyntax-only -w "-I${ROOT}" ${INCLUDES} "${ROOT}/tests/kds/misuse/broken_rules.cc"
                RESULT_VARIABLE failed ERROR_VARIABLE said OUTPUT_VARIABLE said)
if(NOT failed)
  message(FATAL_ERROR "Rules from which a part is missing have compiled.")
endif()
foreach(expected IN ITEMS "must name what moves" "name = ...;` is missing" "must give a certificate"
        "must give a range of ids" "repair(Slot, Repair<Element>&)` is missing" "remove(Id, Repair<Element>&)` are missing"
        "is missing, which a rule with `keeps` must have" "the solver is no FailureTimeSolver" "a type without archive()")
  string(FIND "${said}" "${expected}" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "The compiler does not say \"${expected}\", but:\n${said}")
  endif()
endforeach()
string(REGEX MATCH "[^\n]*static assertion failed: KineticRule<(Base|KeepsAndChanges)>[^\n]*" whole_is_broken "${said}")
if(whole_is_broken)
  message(FATAL_ERROR "A rule from which nothing is missing is refused:\n${said}")
endif()
