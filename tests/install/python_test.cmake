# SPDX-License-Identifier: Apache-2.0
# The Python module is installed and imported from there: cmake -DBUILD= -DPYTHON= -DFOLDER= -DWORK= -P python_test.cmake
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --component python --prefix ${WORK} COMMAND_ERROR_IS_FATAL ANY)
set(ENV{PYTHONPATH} ${WORK}/${FOLDER})
set(script "import kilolux; print(kilolux.__file__, kilolux.render('grid', resolution=(32, 16), lights=9).radiance.shape)")
execute_process(COMMAND ${PYTHON} -B -c "${script}" WORKING_DIRECTORY ${WORK} OUTPUT_VARIABLE out COMMAND_ERROR_IS_FATAL ANY)
if(NOT out STREQUAL "${WORK}/${FOLDER}/kilolux/__init__.py (16, 32, 3)\n")
  message(FATAL_ERROR "the installed module says: ${out}")
endif()
