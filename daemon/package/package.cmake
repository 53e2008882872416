# `cpack --config BUILD/CPackConfig.cmake`: a Debian package of what `cmake --install` puts there,
# and the service. Only where it is to be made (-DMPM_PACKAGE=ON): a prefix of one's own has no
# service to start.
set(here ${CMAKE_CURRENT_LIST_DIR})
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # of SOURCE_DATE_EPOCH, if that is set
configure_file(${here}/changelog.in ${PROJECT_BINARY_DIR}/package/changelog @ONLY)
execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/package/changelog COMMAND_ERROR_IS_FATAL ANY)

install(FILES ${here}/mpmd.service DESTINATION lib/systemd/system)
install(FILES ${here}/sysusers.conf DESTINATION lib/sysusers.d RENAME mpm.conf)
install(FILES ${here}/tmpfiles.conf DESTINATION lib/tmpfiles.d RENAME mpm.conf)
# What the package is made of; of the commit at hand, so made anew each time.
add_custom_target(mpm_sbom ALL
  COMMAND ${here}/sbom.sh ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR} ${PROJECT_VERSION}
    > ${PROJECT_BINARY_DIR}/package/mpm.spdx
  DEPENDS mpm mpmd mpmsim VERBATIM)
install(FILES ${here}/copyright ${PROJECT_BINARY_DIR}/package/changelog.gz
  ${PROJECT_BINARY_DIR}/package/mpm.spdx DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_NAME mpm)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/package)
set(CPACK_PACKAGE_CONTACT "MPM monitor developers <mpm-monitor@lists.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "monitor of the models of model predictive controllers")
set(CPACK_PACKAGE_DESCRIPTION
"Runs beside a control system, subscribes over DDS to the variables of
model predictive controllers and tells which channel of a controller's
model no longer matches the plant, what changed there, and what the
repaired model is. With the service mpmd, the simulator mpmsim and the
engineer's command line mpm.")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "systemd, passwd, tzdata")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${here}/postinst;${here}/prerm;${here}/postrm")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
