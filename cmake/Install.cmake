include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/elastogear)
install(TARGETS elastogear EXPORT elastogearTargets)
install(TARGETS elastogear_app)
install(DIRECTORY include/elastogear DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The report page that `run` makes: its script is bundled by the first page made in the clone (scripts/page/bundle.py).
install(DIRECTORY scripts DESTINATION ${CMAKE_INSTALL_DATADIR}/elastogear USE_SOURCE_PERMISSIONS
        PATTERN __pycache__ EXCLUDE)
install(FILES build/page/page.js build/page/page.css build/page/stamp
        DESTINATION ${CMAKE_INSTALL_DATADIR}/elastogear/build/page OPTIONAL)
if(ELASTOGEAR_HAS_PYTHON_MODULE)
  set(ELASTOGEAR_PYTHON_DIR lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/dist-packages CACHE STRING
      "Where the Python package is installed below the prefix; below /usr/local Debian's Python finds the default")
  install(TARGETS _elastogear LIBRARY DESTINATION ${ELASTOGEAR_PYTHON_DIR}/elastogear COMPONENT python)
  install(DIRECTORY python/elastogear DESTINATION ${ELASTOGEAR_PYTHON_DIR} COMPONENT python
          PATTERN __pycache__ EXCLUDE)
endif()
install(EXPORT elastogearTargets NAMESPACE elastogear:: DESTINATION ${package_dir})
configure_package_config_file(cmake/elastogearConfig.cmake.in elastogearConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(elastogearConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/elastogearConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/elastogearConfigVersion.cmake cmake/Dependencies.cmake
        DESTINATION ${package_dir})
