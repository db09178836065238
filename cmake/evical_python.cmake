# EVICAL_PYTHON builds the Python module, for the system's Python, since it is installed next to that one's packages.
# Included before core, whose libraries must then be position-independent.
set(EVICAL_PYTHON_EXECUTABLE "/usr/bin/python3" CACHE FILEPATH "Python interpreter for which the module is built and tested")
set(evical_python_default OFF)
if(EXISTS "${EVICAL_PYTHON_EXECUTABLE}" AND NOT EVICAL_FUZZ AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(Python_EXECUTABLE "${EVICAL_PYTHON_EXECUTABLE}")
  find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
  find_package(pybind11 2.10 CONFIG QUIET)
  if(Python_FOUND AND pybind11_FOUND)
    set(evical_python_default ON)
  endif()
endif()
option(EVICAL_PYTHON "Build the Python module (needs pybind11, NumPy and Python's headers)" ${evical_python_default})
if(EVICAL_PYTHON AND NOT evical_python_default)
  message(FATAL_ERROR "EVICAL_PYTHON needs pybind11, NumPy and the headers of ${EVICAL_PYTHON_EXECUTABLE}, and a build without sanitizers: "
                      "apt-get install pybind11-dev python3-dev python3-numpy, or -DEVICAL_PYTHON=OFF")
endif()
