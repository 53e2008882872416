# `cmake --install BUILD --prefix PREFIX`: the programs, what shells and `man` need, the types for
# clients, and unit files to begin with. Nothing in there needs the source or the build tree.
include(GNUInstallDirs)

# The programs tell of themselves.
set(said ${PROJECT_BINARY_DIR}/said)
file(MAKE_DIRECTORY ${said})
function(says program output)
  add_custom_command(OUTPUT ${said}/${output} COMMAND ${program} ${ARGN} > ${said}/${output}
    COMMAND gzip -9nfk ${said}/${output} DEPENDS ${program} VERBATIM)
  set_property(GLOBAL APPEND PROPERTY said_files ${said}/${output})
endfunction()
says(mpm mpm.1 man)
says(mpm mpm completion bash)
says(mpm _mpm completion zsh)
says(mpm mpm.fish completion fish)
foreach(program mpmd mpmsim)
  says(${program} ${program}.1 --man)
  says(${program} ${program} --completion bash)
  says(${program} _${program} --completion zsh)
  says(${program} ${program}.fish --completion fish)
endforeach()
says(mpm unit.schema.json schema)
get_property(said_files GLOBAL PROPERTY said_files)
add_custom_target(mpm_said ALL DEPENDS ${said_files})

install(TARGETS mpm mpmd mpmsim RUNTIME)
foreach(program mpm mpmd mpmsim)
  install(FILES ${said}/${program}.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${said}/${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${said}/_${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
  install(FILES ${said}/${program}.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endforeach()
install(FILES idl/mpm.idl DESTINATION ${CMAKE_INSTALL_DATADIR}/mpm)
install(FILES ${said}/unit.schema.json daemon/package/prometheus-rules.yml
  daemon/package/grafana-dashboard.json DESTINATION ${CMAKE_INSTALL_DATADIR}/mpm)
install(FILES tests/hmi/loopback.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mpm RENAME cyclonedds.xml)
install(FILES tests/hmi/secure.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mpm
  RENAME cyclonedds-secure.xml)
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
