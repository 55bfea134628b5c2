include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/elastogear)
install(TARGETS elastogear EXPORT elastogearTargets)
install(TARGETS elastogear_app)
install(DIRECTORY include/elastogear DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT elastogearTargets NAMESPACE elastogear:: DESTINATION ${package_dir})
configure_package_config_file(cmake/elastogearConfig.cmake.in elastogearConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(elastogearConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/elastogearConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/elastogearConfigVersion.cmake cmake/Dependencies.cmake
        DESTINATION ${package_dir})
