cmake_minimum_required(VERSION 3.23)
# Fails if a link of the documentation's site, the pages of the course in it included, leads nowhere.
# -DSITE= the folder of its HTML, -DAWK=
# Doxygen 1.9 leads to the nested classes of a class also where all of them are private and none is shown.
file(GLOB pages "${SITE}/class*.html" "${SITE}/struct*.html")
foreach(page IN LISTS pages)
  file(READ "${page}" html)
  string(FIND "${html}" "<a href=\"#nested-classes\">" link)
  string(FIND "${html}" "name=\"nested-classes\"" place)
  if(link GREATER -1 AND place EQUAL -1)
    string(REGEX REPLACE "<a href=\"#nested-classes\">[^<]*</a>( &#124;\n)?" "" html "${html}")
    file(WRITE "${page}" "${html}")
  endif()
endforeach()
file(GLOB_RECURSE pages "${SITE}/*.html")
execute_process(COMMAND "${AWK}" -v least=100 -f "${CMAKE_CURRENT_LIST_DIR}/page_links.awk" ${pages}
  RESULT_VARIABLE failed OUTPUT_VARIABLE said)
if(NOT failed EQUAL 0)
  message(FATAL_ERROR "The documentation's site:\n${said}")
endif()
