# The events of kds-collide-mpi with PROCESSES processes are those of kds-collide, byte for byte; and what is wrong is
# said once, by one line.
cmake_minimum_required(VERSION 3.23)
include("${CMAKE_CURRENT_LIST_DIR}/run_tools.cmake")

run("${TOOL}" --generate spheres --bodies 3000 --density 0.2 --seed 5 --table --output balls.json --quiet)
run("${TOOL}" balls.json --until 4 --events one.csv --quiet)
run(${MPIRUN} ${PROCESSES} "${MPI_TOOL}" balls.json --until 4 --domains 7 --events several.csv --stats stats.json --quiet)
file(SHA256 "${FOLDER}/one.csv" one)
file(SHA256 "${FOLDER}/several.csv" several)
if(NOT one STREQUAL several)
  message(FATAL_ERROR "the events of ${PROCESSES} processes are not those of one world: ${FOLDER}/several.csv")
endif()

# The same of bodies that turn.
run("${TOOL}" --generate spinning-rings --bodies 200 --density 0.1 --seed 5 --output rings.json --quiet)
run("${TOOL}" rings.json --until 3 --events one_turning.csv --quiet)
run(${MPIRUN} ${PROCESSES} "${MPI_TOOL}" rings.json --until 3 --domains 4 --events several_turning.csv
  --stats turning.json --quiet)
file(READ "${FOLDER}/one_turning.csv" one_turning)
file(READ "${FOLDER}/several_turning.csv" several_turning)
file(READ "${FOLDER}/turning.json" stats)
string(JSON domains GET "${stats}" domains)
string(JSON contacts GET "${stats}" contacts)
if(NOT one_turning STREQUAL several_turning OR NOT domains EQUAL 4 OR contacts LESS 20)
  message(FATAL_ERROR "the events of ${PROCESSES} processes are not those of one world: ${FOLDER}/several_turning.csv, "
                      "or too little has happened: ${stats}")
endif()

# A run that has ended early goes on from its last checkpoint, with as many processes as there are then. What it had
# written after that is dropped. Each process has written the bodies that it answers for.
function(require_parts count)
  file(GLOB parts RELATIVE "${FOLDER}" "${FOLDER}/run.state.*")
  list(LENGTH parts there)
  if(NOT there EQUAL count)
    message(FATAL_ERROR "a checkpoint is to have ${count} parts, and there are: ${parts}")
  endif()
endfunction()
run(${MPIRUN} ${PROCESSES} "${MPI_TOOL}" balls.json --until 4 --domains 4 --events parts.csv --checkpoint run.state
  --checkpoint-every 1.5 --quiet)
require_parts(${PROCESSES})

# Parts that are damaged, cut, missing, or of another checkpoint are named, and nothing is changed.
file(RENAME "${FOLDER}/parts.csv" "${FOLDER}/parts.csv.unfinished")
file(GLOB last "${FOLDER}/run.state.*.1")
get_filename_component(name "${last}" NAME)
set(refused balls.json --until 4 --events parts.csv --checkpoint run.state --checkpoint-every 1.5 --resume)
function(refuses_part expected)
  foreach(with IN ITEMS "${MPIRUN};2;${MPI_TOOL}" "${TOOL}")
    execute_process(COMMAND ${with} ${refused} WORKING_DIRECTORY "${FOLDER}" RESULT_VARIABLE ended OUTPUT_QUIET
      ERROR_VARIABLE text)
    string(FIND "${text}" "${name}: ${expected}" place)
    string(REGEX MATCHALL "(^|\n)run[.]state[^\n]*" lines "${text}")  # which begin with the place, whoever found it
    list(LENGTH lines count)
    if(NOT ended EQUAL 2 OR place EQUAL -1 OR NOT count EQUAL 1)
      message(FATAL_ERROR "${with}: ended with ${ended}, and said:\n${text}\nnot once: ${name}: ${expected}")
    endif()
  endforeach()
endfunction()
file(RENAME "${last}" "${FOLDER}/kept")
refuses_part("file: cannot be read: No such file or directory")
file(WRITE "${last}" "KDSBODY1")
refuses_part("part of a checkpoint: has 8 bytes, and there were ")
run(${MPIRUN} ${PROCESSES} "${MPI_TOOL}" balls.json --until 3 --domains 4 --checkpoint other.state
  --checkpoint-every 1.25 --quiet)
file(GLOB other "${FOLDER}/other.state.*.1")
file(COPY_FILE "${other}" "${last}")
refuses_part("part of a checkpoint: ")
file(RENAME "${FOLDER}/kept" "${last}")
file(RENAME "${FOLDER}/parts.csv.unfinished" "${FOLDER}/parts.csv")

# What ended runs have left is removed by a run that goes on, also if it makes no checkpoint.
file(GLOB named "${FOLDER}/run.state.*")
file(RENAME "${FOLDER}/parts.csv" "${FOLDER}/parts.csv.unfinished")
foreach(turn IN ITEMS a b)
  file(WRITE "${FOLDER}/run.state.${turn}.0.unfinished" "")
  foreach(left IN ITEMS 5 1.unfinished 7.unfinished)
    file(WRITE "${FOLDER}/run.state.${turn}.${left}" "KDSBODY1, and not whole")
  endforeach()
endforeach()
run(${MPIRUN} 2 "${MPI_TOOL}" balls.json --until 4 --events parts.csv --checkpoint run.state --checkpoint-every 100
  --resume --quiet)
file(GLOB left "${FOLDER}/run.state.*")
if(NOT left STREQUAL named)
  message(FATAL_ERROR "a run that went on has left ${left}, not ${named}")
endif()

foreach(with IN ITEMS "${MPIRUN};2;${MPI_TOOL};--domains;3" "${MPIRUN};3;${MPI_TOOL}" "${TOOL}" "${TOOL};--domains;5")
  file(RENAME "${FOLDER}/parts.csv" "${FOLDER}/parts.csv.unfinished")
  run(${with} balls.json --until 4 --events parts.csv --checkpoint run.state --checkpoint-every 1.5 --resume --quiet)
  file(SHA256 "${FOLDER}/parts.csv" parts)
  if(NOT parts STREQUAL one)
    message(FATAL_ERROR "a run that went on with ${with} has other events: ${FOLDER}/parts.csv")
  endif()
endforeach()

# The same of a run of which one process is lost, the first or the last, once there is a checkpoint: MPI ends the
# others, and one of them says what to go on from.
function(lose rank file expected)
  execute_process(COMMAND sh "${CMAKE_CURRENT_LIST_DIR}/lose_a_process.sh" ${rank} "${file}" ${MPIRUN} ${PROCESSES}
    "${MPI_TOOL}" ${ARGN} WORKING_DIRECTORY "${FOLDER}" RESULT_VARIABLE ended OUTPUT_QUIET ERROR_VARIABLE text)
  string(REGEX MATCHALL "kds-collide-mpi: [^\n]*" lines "${text}")
  if(ended EQUAL 0 OR NOT lines MATCHES "^kds-collide-mpi: ended by a signal; ${expected}$")
    message(FATAL_ERROR "process ${rank} was lost: ended with ${ended}, and said:\n${text}\nnot once: ${expected}")
  endif()
endfunction()
math(EXPR last "${PROCESSES} - 1")
set(killed balls.json --until 4 --events killed.csv --checkpoint killed.state)
foreach(rank IN ITEMS 0 ${last})
  # Of two checkpoints the first is known to all processes.
  lose(${rank} killed.state.b.0 "--resume goes on from killed.state, at [0-9.]+ s" ${killed} --domains 4 --checkpoint-every 0.02
    --quiet)
  run(${MPIRUN} 2 "${MPI_TOOL}" ${killed} --checkpoint-every 1.5 --resume --quiet)
  file(SHA256 "${FOLDER}/killed.csv" events)
  if(NOT events STREQUAL one)
    message(FATAL_ERROR "a run that went on after process ${rank} was lost has other events: ${FOLDER}/killed.csv")
  endif()
  file(REMOVE "${FOLDER}/killed.csv" "${FOLDER}/killed.state")
endforeach()
run("${TOOL}" --generate spheres --bodies 20000 --density 0.2 --seed 5 --table --output many.json --quiet)
set(many many.json --until 1000 --domains 4 --rate 1000 --quiet)
lose(0 running.csv.unfinished "there is no checkpoint yet to go on from" ${many} --events running.csv --checkpoint
  none.state --checkpoint-every 900)
lose(${last} other.csv.part-* "there is no checkpoint to go on from: --checkpoint makes some" ${many} --events other.csv)

file(STRINGS "${FOLDER}/one.csv" lines)
list(LENGTH lines count)
file(READ "${FOLDER}/stats.json" stats)
string(JSON windows GET "${stats}" windows)
string(JSON processes GET "${stats}" processes)
string(JSON contacts GET "${stats}" contacts)
if(count LESS 500 OR contacts LESS 500 OR windows LESS 1 OR NOT processes EQUAL PROCESSES)
  message(FATAL_ERROR "too little has happened: ${count} lines, ${stats}")
endif()

function(refuses code expected)
  execute_process(COMMAND ${MPIRUN} ${PROCESSES} "${MPI_TOOL}" ${ARGN} WORKING_DIRECTORY "${FOLDER}"
    RESULT_VARIABLE ended OUTPUT_QUIET ERROR_VARIABLE text)
  string(REGEX MATCHALL "kds-collide-mpi: [^\n]*|[a-z]*\\.json: [^\n]*" lines "${text}")
  if(NOT ended EQUAL code OR NOT lines STREQUAL expected)
    message(FATAL_ERROR "${ARGN}: ended with ${ended}, not ${code}, and said:\n${text}\nnot: ${expected}")
  endif()
endfunction()
refuses(2 "kds-collide-mpi: SCENE: is missing")
refuses(2 "missing.json: file: cannot be read: No such file or directory" missing.json)
refuses(2 "kds-collide-mpi: --domains: there are no pictures of a scene that is divided" balls.json --view page.html)
