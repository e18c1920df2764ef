# Tests of pages in a browser. To start a browser costs more than most pages do in it, so one opens all of them, one
# after the other, as the fixture of the tests that then compare what each of them reported. Debian's package is
# `chromium`; scripts/setup installs it.
find_program(KDS_CHROMIUM NAMES chromium chromium-browser google-chrome DOC "A browser for the tests of pages")
set(KDS_BROWSER_TESTS "${CMAKE_CURRENT_LIST_DIR}")
set(KDS_PAGES_FOLDER "${CMAKE_CURRENT_BINARY_DIR}/pages")

# kds_skipped_page_test(TEST WHAT): a test that says what it would need.
function(kds_skipped_page_test test what)
  add_test(NAME "${test}" COMMAND "${CMAKE_COMMAND}" -E echo "no ${what}: scripts/setup tests installs it")
  set_tests_properties("${test}" PROPERTIES SKIP_REGULAR_EXPRESSION "^no ")
endfunction()

# kds_page_test(TEST NAME name [PAGE file] SIZE WIDTHxHEIGHT DRIVER file [WRITE command...] CHECK command...): the
# browser opens PAGE, NAME.html if that is left out, in a window of that size, with the driver, a script, at its end,
# which calls finished(report) once (else the report is {unfinished: [errors]}); the test TEST runs the command CHECK.
# The page is written by the command WRITE, or by that of a test before it. In both commands {folder}
# is where pages are, {page} is this page there, and {reports} a document with the report as JSON in its script element
# with the id NAME.
function(kds_page_test test)
  cmake_parse_arguments(PARSE_ARGV 1 of "" "NAME;PAGE;SIZE;DRIVER" "WRITE;CHECK")
  if(NOT KDS_CHROMIUM)
    kds_skipped_page_test("${test}" "Chromium")
    return()
  endif()
  if(NOT of_PAGE)
    set(of_PAGE "${of_NAME}.html")
  endif()
  foreach(command IN ITEMS WRITE CHECK)
    string(REPLACE "{page}" "${KDS_PAGES_FOLDER}/${of_PAGE}" of_${command} "${of_${command}}")
    string(REPLACE "{folder}" "${KDS_PAGES_FOLDER}" of_${command} "${of_${command}}")
    string(REPLACE "{reports}" "${KDS_PAGES_FOLDER}/reports.html" of_${command} "${of_${command}}")
  endforeach()
  list(JOIN of_WRITE "|" write)
  set_property(GLOBAL APPEND PROPERTY KDS_PAGES "${of_NAME}|${of_PAGE}|${of_SIZE}|${of_DRIVER}|${write}")
  add_test(NAME "${test}" COMMAND ${of_CHECK})
  set_tests_properties("${test}" PROPERTIES FIXTURES_REQUIRED pages)
endfunction()

# kds_open_pages(): the fixture, after all tests of pages.
function(kds_open_pages)
  get_property(pages GLOBAL PROPERTY KDS_PAGES)
  if(NOT pages)
    return()
  endif()
  list(JOIN pages "\n" pages)
  file(GENERATE OUTPUT "${KDS_PAGES_FOLDER}.txt" CONTENT "${pages}\n")
  add_test(NAME "pages are opened"
    COMMAND "${CMAKE_COMMAND}" "-DCHROMIUM=${KDS_CHROMIUM}" "-DPAGES=${KDS_PAGES_FOLDER}.txt"
      "-DFOLDER=${KDS_PAGES_FOLDER}" -P "${KDS_BROWSER_TESTS}/open_pages.cmake")
  set_tests_properties("pages are opened" PROPERTIES FIXTURES_SETUP pages TIMEOUT 300 COST 40)
endfunction()
