# Debian's Python: another one on the PATH may lack pybind11, numpy, h5py, matplotlib and vtk.
find_program(ELASTOGEAR_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH DOC "Python with numpy, h5py, matplotlib and vtk")
set(ELASTOGEAR_HAS_PYTHON_MODULE OFF)
if(ELASTOGEAR_PYTHON_MODULE AND ELASTOGEAR_PYTHON AND NOT ELASTOGEAR_SANITIZE)  # the interpreter has no sanitizers
  set(Python_EXECUTABLE ${ELASTOGEAR_PYTHON})
  set(PYBIND11_FINDPYTHON ON)
  find_package(Python 3.9 COMPONENTS Interpreter Development.Module QUIET)
  find_package(pybind11 2.10 CONFIG QUIET)
  if(Python_Development.Module_FOUND AND pybind11_FOUND)
    set(ELASTOGEAR_HAS_PYTHON_MODULE ON)
  else()
    message(STATUS "The Python module is left out: python3-dev or pybind11-dev is missing")
  endif()
endif()
