# scripts/package deb: program, library, headers, Python module and documents in one package of the system that it is made on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "The elastogear authors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The elastogear authors <elastogear@localhost>")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libopenblas0, python3, python3-numpy, python3-h5py, python3-yaml")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS  # for programs that use the library
    "libpetsc-real-dev, libslepc-real-dev, libhdf5-openmpi-dev, libmetis-dev, libeigen3-dev")
include(CPack)
