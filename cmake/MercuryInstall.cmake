# SPDX-License-Identifier: Apache-2.0
# cmake --install: the program with its sample robots, and the CMake package `mercury`.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

if(TARGET mercury)
  # The libraries that scripts/bundle packs beside the program. RPATH, not RUNPATH, so that it also applies to what these
  # libraries load.
  set_target_properties(mercury PROPERTIES INSTALL_RPATH $ORIGIN/../lib/mercury)
  target_link_options(mercury PRIVATE LINKER:--disable-new-dtags)
  install(TARGETS mercury RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
if(TARGET mercury AND NOT CMAKE_CROSSCOMPILING)  # the program writes them when it is linked (app/commands)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/descriptions/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
    COMPONENT program FILES_MATCHING PATTERN "*.1")
  install(FILES ${PROJECT_BINARY_DIR}/descriptions/mercury
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
  install(FILES ${PROJECT_BINARY_DIR}/descriptions/_mercury
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program)
  install(FILES ${PROJECT_BINARY_DIR}/descriptions/mercury.fish
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
endif()
if(EXISTS ${PROJECT_SOURCE_DIR}/robots/library)
  install(DIRECTORY robots/library/ DESTINATION ${CMAKE_INSTALL_DATADIR}/mercury/robots COMPONENT program
    FILES_MATCHING PATTERN "*.json" PATTERN "*.cbor")
endif()
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

set(mercury_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mercury)
install(TARGETS mercury_sim mercury_robots mercury_evolution EXPORT mercury
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT mercury NAMESPACE mercury:: FILE mercury-targets.cmake DESTINATION ${mercury_package_dir})
configure_package_config_file(cmake/mercury-config.cmake.in ${PROJECT_BINARY_DIR}/mercury-config.cmake
  INSTALL_DESTINATION ${mercury_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mercury-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/mercury-config.cmake ${PROJECT_BINARY_DIR}/mercury-config-version.cmake
  DESTINATION ${mercury_package_dir})
