cmake_minimum_required(VERSION 3.23)
# Has pages written, opens all of them in one Chromium, each with its driver, and collects what these report.
# -DCHROMIUM= -DPAGES= (a file: in each line NAME|PAGE|SIZE|DRIVER|WRITE...; see page_tests.cmake) -DFOLDER= (written
# to)
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
string(CONCAT collector "<head><script>window.pageErrors = [];"
  "addEventListener('error', (e) => pageErrors.push(String(e.message)));"
  "addEventListener('unhandledrejection', (e) => pageErrors.push(String(e.reason)));"
  "console.error = console.warn = (...all) => pageErrors.push(all.join(' '));"
  # In virtual time frames come when they like, timers when they are due.
  "requestAnimationFrame = (f) => setTimeout(() => f(performance.now()), 16);"
  "window.finished = (report) => parent.postMessage(JSON.stringify(report), '*');"
  # Of a driver that does not get to its end: why.
  "setTimeout(() => finished({unfinished: pageErrors}), 15000);</script>")

file(STRINGS "${PAGES}" lines)
set(list "")
foreach(line IN LISTS lines)
  string(REPLACE "|" ";" line "${line}")
  list(POP_FRONT line name page size driver)
  if(line)
    execute_process(COMMAND ${line} RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
    if(failed)
      message("${name}: ${line} failed (${failed}):\n${said}")
    endif()
  endif()
  # Of a page that is not there the test finds no report.
  if(NOT EXISTS "${FOLDER}/${page}")
    message("${name}: there is no ${page}")
    continue()
  endif()
  # Brackets and semicolons mean nothing to string(REPLACE) as long as everything is quoted.
  file(READ "${FOLDER}/${page}" html)
  file(READ "${driver}" driver)
  string(REPLACE "<head>" "${collector}" html "${html}")
  string(REPLACE "</body>\n</html>" "<script>${driver}</script></body></html>" html "${html}")
  file(WRITE "${FOLDER}/${name}.driven.html" "${html}")
  string(REGEX REPLACE "(.*)x(.*)" "name: '${name}', width: \\1, height: \\2" page "${size}")
  string(APPEND list "{${page}},\n")
endforeach()
file(READ "${CMAKE_CURRENT_LIST_DIR}/one_by_one.html" html)
string(REPLACE "/*{PAGES}*/" "${list}" html "${html}")
file(WRITE "${FOLDER}/one_by_one.html" "${html}")

# WebGL without a graphics card, and nothing else drawn by it: that would take longer. The virtual time, in
# milliseconds, is for all pages; waiting in it costs nothing.
execute_process(
  COMMAND "${CHROMIUM}" --headless --no-sandbox --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader
    --disable-gpu-rasterization --disable-gpu-compositing --disable-dev-shm-usage --disable-extensions
    --disable-background-networking --disable-component-update --disable-sync --no-first-run --hide-scrollbars
    "--user-data-dir=${FOLDER}/profile" --window-size=1300,1000 --virtual-time-budget=1000000
    --dump-dom "file://${FOLDER}/one_by_one.html"
  RESULT_VARIABLE failed OUTPUT_FILE "${FOLDER}/reports.html" ERROR_FILE "${FOLDER}/chromium.log" TIMEOUT 280)
file(REMOVE_RECURSE "${FOLDER}/profile")
if(failed)
  file(READ "${FOLDER}/chromium.log" log)
  message(FATAL_ERROR "${CHROMIUM} failed (${failed}):\n${log}")
endif()
