# cmake -D FOLDER=<of the page's files> -D UPLOT=<its package> -D OUTPUT=<.cpp> -P embed.cmake: the files
# as C++ constants, so that the program finds them wherever it runs.
set(text "#include <string_view>\n\nnamespace mpm::report {\n")
foreach(entry kPageHtml:${FOLDER}/page.html kPageCss:${FOLDER}/page.css kPageJs:${FOLDER}/page.js
    kDrawJs:${FOLDER}/draw.js kUplotJs:${UPLOT}/dist/uPlot.iife.min.js
    kUplotCss:${UPLOT}/dist/uPlot.min.css kUplotLicense:${UPLOT}/LICENSE)
  string(REPLACE ":" ";" entry ${entry})
  list(GET entry 0 name)
  list(GET entry 1 file)
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND text
    "static const char ${name}Bytes[] = {${bytes}};\n"
    "extern const std::string_view ${name};\n"
    "const std::string_view ${name}(${name}Bytes, sizeof ${name}Bytes);\n")
endforeach()
file(WRITE ${OUTPUT} "${text}}  // namespace mpm::report\n")
