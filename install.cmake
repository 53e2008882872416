# `cmake --install BUILD --prefix PREFIX`: the programs, what shells and `man` need, the types for
# clients, and unit files to begin with. Nothing in there needs the source or the build tree.
include(GNUInstallDirs)

# The programs tell of themselves.
function(mpm_says output)
  add_custom_command(OUTPUT ${output} COMMAND mpm ${ARGN} > ${output} DEPENDS mpm VERBATIM)
endfunction()
set(said ${PROJECT_BINARY_DIR}/said)
file(MAKE_DIRECTORY ${said})
mpm_says(${said}/mpm.1 man)
mpm_says(${said}/mpm completion bash)
mpm_says(${said}/_mpm completion zsh)
mpm_says(${said}/mpm.fish completion fish)
add_custom_target(mpm_said ALL
  DEPENDS ${said}/mpm.1 ${said}/mpm ${said}/_mpm ${said}/mpm.fish)

install(TARGETS mpm mpmd mpmsim RUNTIME)
install(FILES ${said}/mpm.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${said}/mpm DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${said}/_mpm DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${said}/mpm.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES idl/mpm.idl DESTINATION ${CMAKE_INSTALL_DATADIR}/mpm)
install(DIRECTORY config/units config/plants config/scenarios
  DESTINATION ${CMAKE_INSTALL_DATADIR}/mpm FILES_MATCHING PATTERN *.yaml)
# The documentation, and all that it links to at the place where it links to it.
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
  FILES_MATCHING PATTERN *.md PATTERN *.html PATTERN *.svg PATTERN *.png
  PATTERN cases/*.json PATTERN cases/*.py)
install(DIRECTORY tests/hmi DESTINATION ${CMAKE_INSTALL_DOCDIR}/tests
  FILES_MATCHING PATTERN *.c PATTERN *.cpp PATTERN *.hpp PATTERN *.py PATTERN *.xml PATTERN *.yaml
  PATTERN CMakeLists.txt)
install(FILES tests/study/experiments.cpp DESTINATION ${CMAKE_INSTALL_DOCDIR}/tests/study)
install(FILES idl/mpm.idl DESTINATION ${CMAKE_INSTALL_DOCDIR}/idl)
install(DIRECTORY config/units config/scenarios config/cases
  DESTINATION ${CMAKE_INSTALL_DOCDIR}/config FILES_MATCHING PATTERN *.yaml)
