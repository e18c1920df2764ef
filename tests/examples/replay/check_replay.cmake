# Makes a replay of a scene and drives it in Chromium.
# -DPROGRAM= kds-collide, -DSCENE= -DCHROMIUM= -DDRIVER= -DFOLDER= (written to)
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
execute_process(COMMAND "${PROGRAM}" "${SCENE}" --view "${FOLDER}/replay.html" --quiet
  RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(failed)
  message(FATAL_ERROR "kds-collide failed (${failed}):\n${said}")
endif()

# Brackets and semicolons mean nothing to string(REPLACE) as long as everything is quoted.
file(READ "${FOLDER}/replay.html" html)
file(READ "${DRIVER}" driver)
string(CONCAT collector "<head><script>window.pageErrors = [];"
  "addEventListener('error', (e) => pageErrors.push(String(e.message)));"
  "console.error = (...all) => pageErrors.push(all.join(' '));"
  # In virtual time frames come when they like, timers when they are due.
  "requestAnimationFrame = (f) => setTimeout(() => f(performance.now()), 100);</script>")
string(REPLACE "<head>" "${collector}" html "${html}")
string(REPLACE "</body>\n</html>" "<script>${driver}</script></body></html>" html "${html}")
file(WRITE "${FOLDER}/driven.html" "${html}")

execute_process(
  COMMAND "${CHROMIUM}" --headless --no-sandbox --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader
    --disable-dev-shm-usage --disable-extensions --disable-background-networking --disable-component-update
    --disable-sync --no-first-run --hide-scrollbars "--user-data-dir=${FOLDER}/profile" --window-size=900,700
    --virtual-time-budget=1500 --dump-dom "file://${FOLDER}/driven.html"
  RESULT_VARIABLE failed OUTPUT_VARIABLE document ERROR_FILE "${FOLDER}/chromium.log" TIMEOUT 120)
file(REMOVE_RECURSE "${FOLDER}/profile")
string(REGEX MATCH "<pre id=\"report\">[^<]*" report "${document}")
if(failed OR NOT report MATCHES "all [0-9]+ checks are right")
  file(READ "${FOLDER}/chromium.log" log)
  message(FATAL_ERROR "The replay in ${FOLDER} is not right (${failed}):\n${report}\n${log}")
endif()
