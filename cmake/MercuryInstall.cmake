# cmake --install: the program with its sample robots, and the CMake package `mercury`.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

if(TARGET mercury)
  install(TARGETS mercury RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(DIRECTORY robots/library/ DESTINATION ${CMAKE_INSTALL_DATADIR}/mercury/robots
  OPTIONAL FILES_MATCHING PATTERN "*.json" PATTERN "*.cbor")
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The headers that a program outside this repository may include. They include no others of ours.
target_sources(mercury_sim PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES
  sim/configuration.h
  sim/error.h
  sim/host_device.h
  sim/material.h
  sim/robot.h
  sim/simulation.h
  sim/telemetry.h
  sim/vec3.h)
file(GLOB robot_headers CONFIGURE_DEPENDS robots/*.h)
target_sources(mercury_robots PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${robot_headers})

set(mercury_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mercury)
install(TARGETS mercury_sim mercury_robots EXPORT mercury
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mercury)
install(EXPORT mercury NAMESPACE mercury:: FILE mercury-targets.cmake DESTINATION ${mercury_package_dir})
configure_package_config_file(cmake/mercury-config.cmake.in ${PROJECT_BINARY_DIR}/mercury-config.cmake
  INSTALL_DESTINATION ${mercury_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mercury-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/mercury-config.cmake ${PROJECT_BINARY_DIR}/mercury-config-version.cmake
  DESTINATION ${mercury_package_dir})
