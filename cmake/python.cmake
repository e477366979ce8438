# import spindrift: Debian's pybind11 and Python, or -DPYTHON_EXECUTABLE=... for another one.
if(NOT PYTHON_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(PYTHON_EXECUTABLE /usr/bin/python3)
endif()
set(PYBIND11_FINDPYTHON OFF)
find_package(pybind11 QUIET)
if(NOT pybind11_FOUND)
  message(STATUS "no pybind11: no Python module (apt-get install pybind11-dev python3-dev)")
  return()
endif()
pybind11_add_module(spindrift_python NO_EXTRAS python/module.cpp)
set_target_properties(spindrift_python PROPERTIES
  OUTPUT_NAME spindrift LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/python)
target_link_libraries(spindrift_python PRIVATE app gpu interop)
install(TARGETS spindrift_python COMPONENT python
  LIBRARY DESTINATION lib/python${PYTHON_VERSION_MAJOR}.${PYTHON_VERSION_MINOR}/site-packages)
if(SPINDRIFT_TESTS)
  enable_testing()
  add_test(NAME python COMMAND ${PYTHON_EXECUTABLE} -m pytest -q -p no:cacheprovider
    ${CMAKE_SOURCE_DIR}/python/test_spindrift.py)
  set(environment
    PYTHONPATH=${CMAKE_BINARY_DIR}/python PYTHONDONTWRITEBYTECODE=1 OMP_WAIT_POLICY=passive)
  set_tests_properties(python PROPERTIES
    LABELS python TIMEOUT 300 ENVIRONMENT "${environment}")
endif()
