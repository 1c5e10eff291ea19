# make install, and find_package(photile) for those who link the library.
include(CMakePackageConfigHelpers)

install(TARGETS photile photile_compile_options EXPORT photileTargets)
install(DIRECTORY include/photile DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT photileTargets NAMESPACE photile:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/photile)
configure_package_config_file(cmake/photileConfig.cmake.in photileConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/photile)
write_basic_package_version_file(photileConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/photileConfig.cmake ${PROJECT_BINARY_DIR}/photileConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/photile)
