cmake_minimum_required(VERSION 3.23)
# Fails unless the driver of a page has reported that all of its checks are right.
# -DNAME= -DREPORTS= (see page_tests.cmake)
file(READ "${REPORTS}" reports)
string(REGEX MATCH "<script[^>]* id=\"${NAME}\">[^<]*" report "${reports}")
if(NOT report MATCHES "\"all [0-9]+ checks are right\"$")
  message(FATAL_ERROR "The page of ${NAME} is not right:\n${report}")
endif()
message("${NAME}: ${CMAKE_MATCH_0}")
