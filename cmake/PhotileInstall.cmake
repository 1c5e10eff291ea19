# make install, and find_package(photile) for those who link the library.
include(CMakePackageConfigHelpers)

install(TARGETS photile photile_compile_options EXPORT photileTargets
  ARCHIVE COMPONENT development)
install(DIRECTORY include/photile DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT photileTargets NAMESPACE photile:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/photile
  COMPONENT development)
configure_package_config_file(cmake/photileConfig.cmake.in photileConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/photile)
write_basic_package_version_file(photileConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/photileConfig.cmake ${PROJECT_BINARY_DIR}/photileConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/photile COMPONENT development)

# Kernels compiled for the devices of this machine, for all of its users:
#   cmake --install BUILD --component kernels
install(CODE "
  set(scratch \"${PROJECT_BINARY_DIR}/installed-kernels\")
  file(REMOVE_RECURSE \"\${scratch}\")
  file(MAKE_DIRECTORY \"\${scratch}\")
  execute_process(
    COMMAND \"\${CMAKE_COMMAND}\" -E env \"XDG_CACHE_HOME=\${scratch}\" XDG_DATA_DIRS=
      \"${PROJECT_BINARY_DIR}/photile\" devices --compile
    COMMAND_ERROR_IS_FATAL ANY)
  file(INSTALL \"\${scratch}/photile/kernels\"
    DESTINATION \"\${CMAKE_INSTALL_PREFIX}/share/photile\")"
  COMPONENT kernels EXCLUDE_FROM_ALL)
