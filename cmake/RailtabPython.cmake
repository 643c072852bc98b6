# RAILTAB_PYTHON: the module `import railtab` (python/). AUTO: where pybind11 and the headers of Python are found.
# Debian's packages are those of /usr/bin/python3, which is taken before another python3 of the PATH;
# -D Python_EXECUTABLE=… names one.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python 3.10 QUIET COMPONENTS Interpreter Development.Module NumPy)
find_path(RAILTAB_PYBIND11_INCLUDE pybind11/pybind11.h)
set(railtab_python_found OFF)
if(Python_FOUND AND RAILTAB_PYBIND11_INCLUDE)
  set(railtab_python_found ON)
endif()
set(RAILTAB_PYTHON AUTO CACHE STRING
  "Build the Python module (needs pybind11, NumPy, h5py): ON, OFF, or AUTO, where these are found")
if(RAILTAB_PYTHON STREQUAL AUTO)
  set(RAILTAB_PYTHON ${railtab_python_found})  # anew at every configuration: what is installed later counts
endif()
if(RAILTAB_PYTHON AND NOT railtab_python_found)
  message(FATAL_ERROR "RAILTAB_PYTHON: found no pybind11, NumPy or headers of Python; expected Debian's packages, "
    "which tools/install_dependencies --python installs; or -D RAILTAB_PYTHON=OFF")
endif()
