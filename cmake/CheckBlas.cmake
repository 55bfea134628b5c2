# Warns when the BLAS that PETSc and MUMPS load at run time is not an optimised one: with the reference BLAS a
# factorisation takes several times as long. Also runs as a script: cmake -DELASTOGEAR_BLAS_LIBRARY=... -P this
find_library(ELASTOGEAR_BLAS_LIBRARY NAMES libblas.so.3 DOC "BLAS that programs load at run time")
mark_as_advanced(ELASTOGEAR_BLAS_LIBRARY)
if(ELASTOGEAR_BLAS_LIBRARY)
  file(REAL_PATH "${ELASTOGEAR_BLAS_LIBRARY}" blas_file)
  string(REGEX MATCH "[^/]*/[^/]*$" blas_name "${blas_file}")  # e.g. openblas-pthread/libblas.so.3
  if(NOT blas_name MATCHES "openblas|flexiblas|blis|mkl|atlas|armpl")
    message(WARNING "The BLAS in use, ${blas_file}, is not an optimised one (reference BLAS?). "
                    "Install libopenblas-dev; choose it by update-alternatives --config libblas.so.3-<architecture>.")
  endif()
endif()
