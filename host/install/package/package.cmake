# SPDX-License-Identifier: Apache-2.0
# CPack: the Debian packages kilolux, libkilolux-dev and python3-kilolux. host/package builds them.
set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_NAME kilolux)
set(CPACK_PACKAGE_VENDOR Kilolux)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The Kilolux developers <kilolux@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "renderer of scenes with thousands to a hundred million lights")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(packages development:libkilolux-dev)
if(KILOLUX_PROGRAM)
  list(APPEND packages program:kilolux)
endif()
if(TARGET kilolux_python)
  list(APPEND packages python:python3-kilolux)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# dpkg-shlibdeps finds the library of images in the build folder, not in a package.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})

set(opencl "pocl-opencl-icd | opencl-icd")
set(opengl "libegl1, libgl1-mesa-dri, fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME kilolux)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${opencl}, ${opengl}")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "ffmpeg, gnuplot-nox")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "The command line and the window.
 Lights glTF scenes and generated ones by clustered deferred shading in OpenCL
 and shows the error of the picture beside its speed.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libkilolux-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "ocl-icd-opencl-dev | opencl-dev, opencl-c-headers, opencl-clhpp-headers")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "${opencl}")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "The OpenCL half as a library for C and C++.
 Light lists and deferred lighting over the G-buffer of another renderer.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-kilolux)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
# The module is built for one version of Python.
set(next_python)
if(TARGET kilolux_python)
  math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy, ${opencl}, ${opengl}")
# Python writes compiled modules beside these, which dpkg does not know.
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/host/install/package/python/postinst
  ${CMAKE_SOURCE_DIR}/host/install/package/python/prerm)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)  # whatever those of the source are
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python module.
 Renders to numpy arrays and lights G-buffers that are numpy arrays.")
foreach(package IN LISTS packages)
  string(REPLACE ":" ";" words ${package})
  list(POP_FRONT words component name)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  install(FILES host/install/package/copyright DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${name} COMPONENT ${component})
endforeach()
include(CPack)

if(NOT KILOLUX_PROGRAM)
  return()
endif()
install(FILES host/install/package/kilolux.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
install(FILES host/install/package/kilolux.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps
  COMPONENT program)
# Made by the program itself when it is installed, so that they name its options.
install(CODE "set(kilolux \"$<TARGET_FILE:kilolux>\")
  set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\")
  include(\"${CMAKE_SOURCE_DIR}/host/install/package/documents.cmake\")" COMPONENT program)
