# Everything elastogear links, as imported targets; used by the build and by the installed package.
find_package(PkgConfig REQUIRED)
# Debian's packages with 64-bit indices call themselves petsc64 and slepc64.
pkg_search_module(PETSC REQUIRED IMPORTED_TARGET GLOBAL petsc>=3.18 petsc64>=3.18)
string(REPLACE petsc slepc slepc_module "${PETSC_MODULE_NAME}")
pkg_check_modules(SLEPC REQUIRED IMPORTED_TARGET GLOBAL ${slepc_module}>=3.18)
# The types that are registered with PETSc and SLEPc (TS generalized_alpha, EPS block_lanczos, PC ldl, BV slabs) are
# written against their private headers, those of 3.18.5 (Debian 12) and 3.22.5 (Debian 13).
foreach(library PETSC SLEPC)
  if(NOT ${library}_VERSION VERSION_LESS 3.23)
    message(FATAL_ERROR "${library} ${${library}_VERSION}: must be 3.18 to 3.22, whose private headers the registered "
                        "solvers include (petsc/private/tsimpl.h, pcimpl.h, slepc/private/epsimpl.h, bvimpl.h)")
  endif()
endforeach()
find_package(MPI REQUIRED COMPONENTS C)
set(HDF5_PREFER_PARALLEL ON)
find_package(HDF5 REQUIRED COMPONENTS C)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
if(NOT TARGET METIS::METIS)
  find_path(METIS_INCLUDE_DIR metis.h REQUIRED)
  find_library(METIS_LIBRARY metis REQUIRED)
  add_library(METIS::METIS UNKNOWN IMPORTED GLOBAL)
  set_target_properties(METIS::METIS PROPERTIES IMPORTED_LOCATION "${METIS_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${METIS_INCLUDE_DIR}")
endif()
if(NOT TARGET MUMPS::DMUMPS)
  # That of PETSc (dmumps_64 with Debian's 64-bit indices): two of them in one program share the names of their functions.
  set(dmumps_of_petsc ${PETSC_STATIC_LIBRARIES})
  list(FILTER dmumps_of_petsc INCLUDE REGEX "^dmumps")
  find_path(MUMPS_INCLUDE_DIR dmumps_c.h REQUIRED)
  find_library(DMUMPS_LIBRARY NAMES ${dmumps_of_petsc} dmumps REQUIRED)
  add_library(MUMPS::DMUMPS UNKNOWN IMPORTED GLOBAL)
  set_target_properties(MUMPS::DMUMPS PROPERTIES IMPORTED_LOCATION "${DMUMPS_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${MUMPS_INCLUDE_DIR}")
endif()
if(NOT TARGET LAPACK)  # the same files as PETSc's, so that Debian's choice of BLAS holds for both
  find_library(ELASTOGEAR_LAPACK lapack REQUIRED)
  find_library(ELASTOGEAR_BLAS blas REQUIRED)
  add_library(LAPACK INTERFACE IMPORTED GLOBAL)
  target_link_libraries(LAPACK INTERFACE "${ELASTOGEAR_LAPACK}" "${ELASTOGEAR_BLAS}")
endif()
