# Runs a program of the course, drives its page in Chromium and has what was seen there checked.
# -DNAME= -DPROGRAM= -DCHROMIUM= -DCHECKER= -DDRIVER= -DFOLDER= (written to) -DWIDTH=
# -DCHANGES=ON: the driver changes motions, and the checker compares what follows with the program itself.
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
set(page "${FOLDER}/${NAME}.html")
execute_process(COMMAND "${PROGRAM}" "${page}" RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(failed)
  message(FATAL_ERROR "${NAME} failed (${failed}):\n${said}")
endif()

# Brackets and semicolons mean nothing to string(REPLACE) as long as everything is quoted.
file(READ "${page}" html)
file(READ "${DRIVER}" driver)
string(CONCAT collector "<head><script>window.pageErrors = [];"
  "addEventListener('error', (e) => pageErrors.push(String(e.message)));"
  "addEventListener('unhandledrejection', (e) => pageErrors.push(String(e.reason)));"
  "console.error = console.warn = (...all) => pageErrors.push(all.join(' '));"
  # In virtual time frames come when they like, timers when they are due.
  "requestAnimationFrame = (f) => setTimeout(() => f(performance.now()), 16);</script>")
string(REPLACE "<head>" "${collector}" html "${html}")
string(REPLACE "</body>" "<script>${driver}</script></body>" html "${html}")
file(WRITE "${FOLDER}/driven.html" "${html}")

execute_process(
  COMMAND "${CHROMIUM}" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --disable-extensions
    --disable-background-networking --disable-component-update --disable-sync --no-first-run --hide-scrollbars
    "--user-data-dir=${FOLDER}/profile" "--window-size=${WIDTH},900" --virtual-time-budget=20000
    --dump-dom "file://${FOLDER}/driven.html"
  RESULT_VARIABLE failed OUTPUT_FILE "${FOLDER}/document.html" ERROR_FILE "${FOLDER}/chromium.log" TIMEOUT 120)
file(REMOVE_RECURSE "${FOLDER}/profile")
if(failed)
  file(READ "${FOLDER}/chromium.log" log)
  message(FATAL_ERROR "${CHROMIUM} failed (${failed}):\n${log}")
endif()

if(CHANGES)
  set(arguments "${PROGRAM}" "${FOLDER}/document.html" "${FOLDER}")
else()
  set(arguments "${NAME}" "${page}" "${FOLDER}/document.html")
endif()
execute_process(COMMAND "${CHECKER}" ${arguments} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "the page of ${NAME} is not right; see ${FOLDER}")
endif()
