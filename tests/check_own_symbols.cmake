cmake_minimum_required(VERSION 3.23)
# Of an ordinary inline function that several object files have, a linker takes any. So files named `*_by_four`,
# compiled for some processors only, must define nothing that others define too: every symbol others see has that name.
list(FILTER OBJECTS INCLUDE REGEX "_by_four\\.cpp")
if(NOT OBJECTS)
  message(FATAL_ERROR "No object file of that kind")
endif()
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND "${NM}" --defined-only --extern-only --format=posix "${object}"
    OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" lines "${symbols}")
  # What compilers add for exceptions is data.
  list(FILTER lines EXCLUDE REGEX "^DW\\.ref\\.|_by_four")
  if(lines)
    list(JOIN lines "\n  " shown)
    message(FATAL_ERROR "${object} defines\n  ${shown}")
  endif()
endforeach()
