# SPDX-License-Identifier: Apache-2.0
# The Python module is installed and imported from there: cmake -DBUILD= -DPYTHON= -DFOLDER= -DWORK= -P python_test.cmake
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --component python --prefix ${WORK} COMMAND_ERROR_IS_FATAL ANY)
set(ENV{PYTHONPATH} ${WORK}/${FOLDER})
file(WRITE ${WORK}/broken.hdr "no image")  # its reader is a library of its own, installed beside the module
set(script "import kilolux
try: kilolux.render('grid', resolution=(32, 16), lights=9, environment='broken.hdr')
except kilolux.Error as error: print(error)
print(kilolux.__file__, kilolux.render('grid', resolution=(32, 16), lights=9).radiance.shape)")
execute_process(COMMAND ${PYTHON} -B -c "${script}" WORKING_DIRECTORY ${WORK} OUTPUT_VARIABLE out COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "^broken.hdr: cannot read the image: [^\n]+\n" "" rest "${out}")
if(rest STREQUAL out OR NOT rest STREQUAL "${WORK}/${FOLDER}/kilolux/__init__.py (16, 32, 3)\n")
  message(FATAL_ERROR "the installed module says: ${out}")
endif()
