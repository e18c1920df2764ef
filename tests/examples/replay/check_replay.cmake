# Fails if a replay's page was not right, or did not get to its end.
# -DNAME= -DREPORTS= (see ../browser/page_tests.cmake)
file(READ "${REPORTS}" reports)
string(REGEX MATCH "<script[^>]* id=\"${NAME}\">[^<]*" report "${reports}")
if(NOT report MATCHES "\"all [0-9]+ checks are right\"$")
  message(FATAL_ERROR "The replay of ${NAME} is not right:\n${report}")
endif()
message("${NAME}: ${CMAKE_MATCH_0}")
