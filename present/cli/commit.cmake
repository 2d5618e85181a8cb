# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a C++ file that defines commit() and built_with(), from the commit of ROOT and BUILT_WITH, unless it
# holds them already.
execute_process(COMMAND git describe --always --dirty --tags --abbrev=12 WORKING_DIRECTORY ${ROOT}
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE no_git)
if(no_git OR NOT commit)
  set(commit unknown)
endif()
set(text "#include \"present/cli/commit.h\"\n\nstd::string kilolux::commit() { return \"${commit}\"; }
std::string kilolux::built_with() { return \"${BUILT_WITH}\"; }\n")
set(found)
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} found)
endif()
if(NOT found STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
