# cmake -D FOLDER=<of package.json> -D WORK=<folder> -D WHAT=<words> -D STAMP=<file> -P fetch.cmake: the
# packages of package-lock.json from the npm registry (or npm's cache) into WORK/node_modules, in the
# versions and with the hashes that stand there; then touches STAMP.
find_program(npm npm)
if(NOT npm)
  message(FATAL_ERROR "npm is missing: it fetches ${WHAT}. `./run build` installs it, or: apt-get install npm")
endif()
file(COPY ${FOLDER}/package.json ${FOLDER}/package-lock.json DESTINATION ${WORK})
execute_process(
  COMMAND ${npm} ci --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE said)
if(failed)
  message(FATAL_ERROR "npm does not get ${WHAT}. It needs the npm registry once "
    "(`npm config get registry`), later its cache will do. npm says:\n${said}")
endif()
file(TOUCH ${STAMP})
