# SPDX-License-Identifier: Apache-2.0
# The program is installed, and finds its library of images from there: cmake -DBUILD= -DWORK= -P program_test.cmake
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/bin/kilolux render grid --resolution 64,36 --lights 9 --quiet -o picture.png
  WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)
file(READ ${WORK}/picture.png magic LIMIT 4 HEX)
if(NOT magic STREQUAL "89504e47")
  message(FATAL_ERROR "picture.png begins with ${magic}")
endif()
file(REMOVE_RECURSE ${WORK})
