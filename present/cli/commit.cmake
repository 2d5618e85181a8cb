# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a C++ file that defines commit(), unless it has the commit of ROOT already.
execute_process(COMMAND git describe --always --dirty --tags WORKING_DIRECTORY ${ROOT}
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE no_git)
if(no_git OR NOT commit)
  set(commit unknown)
endif()
set(text "#include \"present/cli/commit.h\"\n\nstd::string kilolux::commit() { return \"${commit}\"; }\n")
set(found)
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} found)
endif()
if(NOT found STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
