# cmake -D FOLDER=<of package.json> -D WORK=<folder> -P fetch.cmake: compiler, bundler and drawing library
# of the page from the npm registry (or npm's cache) into WORK/node_modules, in the versions and with
# the hashes of package-lock.json.
find_program(npm npm)
if(NOT npm)
  message(FATAL_ERROR "npm is missing: the operator page is bundled with esbuild, which npm fetches. "
    "`./run build` installs it, or: apt-get install npm")
endif()
file(COPY ${FOLDER}/package.json ${FOLDER}/package-lock.json DESTINATION ${WORK})
execute_process(
  COMMAND ${npm} ci --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE said)
if(failed)
  message(FATAL_ERROR "npm does not get what the operator page is made with. It needs the npm registry "
    "once (`npm config get registry`), later its cache will do. npm says:\n${said}")
endif()
file(TOUCH ${WORK}/fetched)
