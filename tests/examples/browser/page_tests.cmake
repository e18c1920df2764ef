# Tests of pages in a browser. To start a browser costs more than most pages do in it, so one opens all the pages of a
# group, one after the other, as the fixture of the tests that then compare what each of them reported.
# Debian's package is `chromium`; scripts/setup installs it.
find_program(KDS_CHROMIUM NAMES chromium chromium-browser google-chrome DOC "A browser for the tests of pages")
set(KDS_BROWSER_TESTS "${CMAKE_CURRENT_LIST_DIR}")

# kds_skipped_page_test(TEST WHAT): a test that says what it would need.
function(kds_skipped_page_test test what)
  add_test(NAME "${test}" COMMAND "${CMAKE_COMMAND}" -E echo "no ${what}: scripts/setup tests installs it")
  set_tests_properties("${test}" PROPERTIES SKIP_REGULAR_EXPRESSION "^no ")
endfunction()

# kds_page_test(GROUP TEST NAME name SIZE WIDTHxHEIGHT DRIVER file WRITE command... CHECK command...): the command WRITE
# writes a page; the browser opens it in a window of that size, with the driver, a script, at its end, which calls
# finished(report) once (else the report is {unfinished: [errors]}); the test TEST runs the command CHECK. In both
# commands {page} is the file of the page, and in CHECK {reports} a document with the report as JSON in its script
# element with the id NAME.
function(kds_page_test group test)
  cmake_parse_arguments(PARSE_ARGV 2 of "" "NAME;SIZE;DRIVER" "WRITE;CHECK")
  if(NOT KDS_CHROMIUM)
    kds_skipped_page_test("${test}" "Chromium")
    return()
  endif()
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/pages")
  set(page "${folder}/${of_NAME}.html")
  string(REPLACE "{page}" "${page}" write "${of_WRITE}")
  string(REPLACE "{page}" "${page}" check "${of_CHECK}")
  string(REPLACE "{reports}" "${folder}/reports.html" check "${check}")
  list(JOIN write "|" write)
  set_property(GLOBAL APPEND PROPERTY "KDS_PAGES_${group}" "${of_NAME}|${of_SIZE}|${of_DRIVER}|${write}")
  add_test(NAME "${test}" COMMAND ${check})
  set_tests_properties("${test}" PROPERTIES FIXTURES_REQUIRED "${group} pages")
endfunction()

# kds_open_pages(GROUP): the fixture, after all tests of the group.
function(kds_open_pages group)
  get_property(pages GLOBAL PROPERTY "KDS_PAGES_${group}")
  if(NOT pages)
    return()
  endif()
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/pages")
  list(JOIN pages "\n" pages)
  file(GENERATE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/pages.txt" CONTENT "${pages}\n")
  add_test(NAME "${group} pages are opened"
    COMMAND "${CMAKE_COMMAND}" "-DCHROMIUM=${KDS_CHROMIUM}" "-DPAGES=${CMAKE_CURRENT_BINARY_DIR}/pages.txt"
      "-DFOLDER=${folder}" -P "${KDS_BROWSER_TESTS}/open_pages.cmake")
  set_tests_properties("${group} pages are opened" PROPERTIES FIXTURES_SETUP "${group} pages" TIMEOUT 300 COST 30)
endfunction()
