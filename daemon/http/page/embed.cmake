# cmake -D FOLDER=<of the page> -D WORK=<of the bundle> -D OPENAPI=<file> -D OUTPUT=<.cpp> -P embed.cmake:
# the files as C++ constants, each with the tag that says whether a browser has it already.
set(text "#include <string_view>\n\nnamespace mpm::http {\n")
foreach(entry kIndexHtml:${FOLDER}/index.html kPageJs:${WORK}/page.js kPageCss:${WORK}/page.css
    kOpenapiJson:${OPENAPI})
  string(REPLACE ":" ";" entry ${entry})
  list(GET entry 0 name)
  list(GET entry 1 file)
  file(SHA256 ${file} tag)
  string(SUBSTRING ${tag} 0 16 tag)
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND text
    "static const char ${name}Bytes[] = {${bytes}};\n"
    "extern const std::string_view ${name}, ${name}Tag;\n"
    "const std::string_view ${name}(${name}Bytes, sizeof ${name}Bytes);\n"
    "const std::string_view ${name}Tag(\"\\\"${tag}\\\"\");\n")
endforeach()
file(WRITE ${OUTPUT} "${text}}  // namespace mpm::http\n")
