# cmake -D FOLDER=<of package.json> -D WORK=<folder> -P fetch.cmake: the page's drawing library from the
# npm registry (or npm's cache) into WORK/node_modules, in the version and with the hash of
# package-lock.json.
find_program(npm npm)
if(NOT npm)
  message(FATAL_ERROR "npm is missing: the report's page is drawn with uPlot, which npm fetches. "
    "`./run build` installs it, or: apt-get install npm")
endif()
file(COPY ${FOLDER}/package.json ${FOLDER}/package-lock.json DESTINATION ${WORK})
execute_process(
  COMMAND ${npm} ci --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE said)
if(failed)
  message(FATAL_ERROR "npm does not get uPlot, which the report's page is drawn with. It needs the npm "
    "registry once (`npm config get registry`), later its cache will do. npm says:\n${said}")
endif()
file(TOUCH ${WORK}/node_modules/uplot/dist/uPlot.iife.min.js)
