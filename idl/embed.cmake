# cmake -D INPUT=<mpm.idl> -D OUTPUT=<.cpp> -P embed.cmake: the text of the types as a C++ constant, so
# that a recording can carry it wherever it is made.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
file(WRITE ${OUTPUT}
  "#include <string_view>\n\nnamespace mpm::idl {\n"
  "static const char kBytes[] = {${bytes}};\n"
  "extern const std::string_view kIdlText;\n"
  "const std::string_view kIdlText(kBytes, sizeof kBytes);\n"
  "}  // namespace mpm::idl\n")
