# SPDX-License-Identifier: Apache-2.0
# Installs headers as others see them: one include root, <kilolux/...>, and macros that begin with
# KILOLUX_. The tree's own, and the kernels in the library, have the short names.
#   cmake -DROOT=<source> -DDESTINATION=<folder kilolux> "-DROOMS=host/base|..." -P public_headers.cmake
cmake_minimum_required(VERSION 3.22)
string(REPLACE "|" ";" ROOMS "${ROOMS}")
set(headers "")
foreach(room IN LISTS ROOMS)
  file(GLOB found RELATIVE ${ROOT} ${ROOT}/${room}/*.h ${ROOT}/${room}/*/*.h)
  list(APPEND headers ${found})
endforeach()
# kilolux_c.h is copied below; parallel.h needs oneTBB, which the library does not.
list(REMOVE_ITEM headers host/lighting/kilolux_c.h host/base/system/parallel.h)
# What kernels and shaders alone compile says so in its first lines.
foreach(header IN LISTS headers)
  file(STRINGS ${ROOT}/${header} first LIMIT_COUNT 3)
  if(first MATCHES "for OpenCL C and GLSL")
    list(REMOVE_ITEM headers ${header})
  endif()
endforeach()

# Names that C++ has as types; OpenCL C and GLSL as macros.
set(types FV IV UV VW MASK)
set(macros "")
foreach(header IN LISTS headers)
  file(STRINGS ${ROOT}/${header} lines REGEX "^ *# *define +[A-Z]")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^ *# *define +([A-Za-z0-9_]+).*" "\\1" name "${line}")
    if(NOT name MATCHES "^KILOLUX_" AND NOT name IN_LIST types)
      list(APPEND macros ${name})
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES macros)

function(publish from to)
  file(READ ${ROOT}/${from} text)
  string(REGEX REPLACE "#include \"((host|kernels)/[^\"]*)\"" "#include <kilolux/\\1>" text "${text}")
  # Families that comments name: SHADING_*.
  string(REGEX REPLACE "([^A-Za-z0-9_])([A-Z][A-Z_]*_\\*)" "\\1KILOLUX_\\2" text "${text}")
  foreach(name IN LISTS macros)
    string(FIND "${text}" "${name}" at)
    if(at EQUAL -1)
      continue()
    endif()
    foreach(time 1 2)  # neighbours share the character between them
      string(REGEX REPLACE "([^A-Za-z0-9_])${name}([^A-Za-z0-9_])" "\\1KILOLUX_${name}\\2" text "${text}")
    endforeach()
  endforeach()
  file(WRITE ${DESTINATION}/${to} "${text}")
endfunction()

foreach(header IN LISTS headers)
  publish(${header} ${header})
endforeach()
publish(host/install/kilolux.h kilolux.h)
file(COPY ${ROOT}/host/lighting/kilolux_c.h DESTINATION ${DESTINATION}
  FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)  # whatever those of the source are
