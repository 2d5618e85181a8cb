# SPDX-License-Identifier: Apache-2.0
# The Python module, where Python's headers, numpy and pybind11 are: build/python/kilolux. Debian's own interpreter is
# taken before others in PATH, since the package lists install for it; -DPython3_EXECUTABLE=... names another.
option(KILOLUX_PYTHON "Build the Python module where Python's headers, numpy and pybind11 are" ON)
add_custom_target(python)  # the module, or nothing
if(NOT KILOLUX_PYTHON OR (KILOLUX_SANITIZE AND NOT KILOLUX_SANITIZE STREQUAL "address,undefined"))  # no other sanitizer can be loaded later
  return()
endif()
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 COMPONENTS Interpreter Development.Module NumPy QUIET)
find_package(pybind11 2.10 CONFIG QUIET)
if(NOT Python3_FOUND OR NOT pybind11_FOUND)
  message(STATUS "kilolux: no Python module: needs python3-dev, python3-numpy and pybind11-dev")
  return()
endif()

file(GLOB python_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/present/python/*.cpp)
Python3_add_library(kilolux_python MODULE WITH_SOABI ${python_sources})
add_dependencies(python kilolux_python)
target_link_libraries(kilolux_python PRIVATE kilolux_present pybind11::headers kilolux_options)
set(python_folder ${CMAKE_BINARY_DIR}/python/kilolux)
target_compile_options(kilolux_python PRIVATE -O1)  # bindings: the work is in the libraries
set_target_properties(kilolux_python PROPERTIES OUTPUT_NAME _native LIBRARY_OUTPUT_DIRECTORY ${python_folder}
  CXX_VISIBILITY_PRESET hidden UNITY_BUILD ${KILOLUX_UNITY} UNITY_BUILD_BATCH_SIZE 12)
file(GLOB python_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/present/python/kilolux/*)
file(MAKE_DIRECTORY ${python_folder})
foreach(file IN LISTS python_files)
  get_filename_component(name ${file} NAME)
  file(CREATE_LINK ${file} ${python_folder}/${name} SYMBOLIC)
endforeach()

# The types of the keywords, from the list of options that was built.
set(make_options ${CMAKE_SOURCE_DIR}/present/python/make_options.py)
set(KILOLUX_PYTHON_ENVIRONMENT)
# A plain interpreter loads an instrumented module where the sanitizer's library is loaded first. What the interpreter leaks is not ours,
# and tests/run says why no signal stack is used.
if(KILOLUX_SANITIZE)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libasan.so OUTPUT_VARIABLE asan OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(KILOLUX_PYTHON_ENVIRONMENT LD_PRELOAD=${asan} ASAN_OPTIONS=detect_leaks=0:use_sigaltstack=0 PYTHONMALLOC=malloc)
endif()
add_custom_command(TARGET kilolux_python POST_BUILD
  COMMAND ${CMAKE_COMMAND} -E env ${KILOLUX_PYTHON_ENVIRONMENT} ${Python3_EXECUTABLE} -B ${make_options} ${python_folder}
  BYPRODUCTS ${python_folder}/options.py VERBATIM)

# Where this Python looks below a prefix: lib/python3.11/dist-packages, where Debian's packages have lib/python3.
execute_process(COMMAND ${Python3_EXECUTABLE} -c "import os, sysconfig; print(os.path.basename(sysconfig.get_path('purelib')))"
  OUTPUT_VARIABLE python_packages OUTPUT_STRIP_TRAILING_WHITESPACE)
set(python_version ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR})
if(CMAKE_INSTALL_PREFIX STREQUAL /usr)
  set(python_version 3)
endif()
set(KILOLUX_PYTHON_FOLDER lib/python${python_version}/${python_packages} CACHE STRING
  "Where the Python module is installed, below the prefix")
install(TARGETS kilolux_python LIBRARY DESTINATION ${KILOLUX_PYTHON_FOLDER}/kilolux COMPONENT python)
install(TARGETS kilolux_images_module LIBRARY DESTINATION ${KILOLUX_PYTHON_FOLDER}/kilolux COMPONENT python)
install(FILES ${python_files} ${python_folder}/options.py DESTINATION ${KILOLUX_PYTHON_FOLDER}/kilolux COMPONENT python)
