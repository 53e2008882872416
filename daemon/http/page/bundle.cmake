# cmake -D FOLDER=<of the page> -D WORK=<with node_modules> -D DRAW=<draw.js> -P bundle.cmake: page.js and
# page.css in WORK. The report's drawing code becomes a module of the page: its one tie to the report
# is `page.zone`.
file(GLOB sources ${FOLDER}/*.ts ${FOLDER}/*.css ${FOLDER}/tsconfig.json)
file(MAKE_DIRECTORY ${WORK}/source)
file(COPY ${sources} DESTINATION ${WORK}/source)
file(READ ${DRAW} draw)
file(WRITE ${WORK}/source/draw.js "import uPlot from 'uplot';\nconst page = {zone: true};\n${draw}\n"
  "export {element, figure, number, setZone, localDate};\n")
foreach(command "tsc;-p;source" "esbuild;source/main.ts;--bundle;--minify;--target=chrome110,firefox110,safari16;--charset=utf8;--legal-comments=eof;--outfile=page.js;--log-level=warning"
    "esbuild;source/page.css;--bundle;--minify;--target=chrome110,firefox110,safari16;--outfile=page.css;--log-level=warning")
  list(POP_FRONT command program)
  execute_process(COMMAND ${WORK}/node_modules/.bin/${program} ${command} WORKING_DIRECTORY ${WORK}
    RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE complained)
  if(failed)
    message(FATAL_ERROR "${program}: ${said}${complained}")
  endif()
endforeach()
# Who gets the page gets the licence of what is in it.
file(READ ${WORK}/node_modules/uplot/LICENSE licence)
file(READ ${WORK}/page.js bundle)
file(WRITE ${WORK}/page.js "/* With uPlot, of which holds:\n${licence}*/\n${bundle}")
