# Links of the pages of the course, and of what is rendered of the documentation beside them, lead somewhere.
# -DFOLDER= where the pages are, -DROOT= the sources, -DAWK=
file(GLOB_RECURSE pages "${FOLDER}/*.html")
execute_process(COMMAND "${AWK}" -v least=20 -f "${ROOT}/cmake/page_links.awk" ${pages}
  RESULT_VARIABLE failed OUTPUT_VARIABLE said)
message("${said}")
if(NOT failed EQUAL 0)
  message(FATAL_ERROR "A link of the course leads nowhere")
endif()
