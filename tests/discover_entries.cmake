# SPDX-License-Identifier: Apache-2.0
# Included by ctest: adds its entries for PROGRAM, a Google Test program, from LIST, a file that is written again when PROGRAM is newer. An
# entry holds the cases of which the regular expression ENTRY matches the same beginning of the full name. The part of an entry's name after
# PREFIX is the program's --gtest_filter. PROPERTIES are those of each entry. Entries that the regular expression UNIT matches also have the
# label `unit`; one whose name matches SERIAL runs alone.
cmake_minimum_required(VERSION 3.22)

if(NOT EXISTS ${PROGRAM})
  add_test(${PROGRAM}_NOT_BUILT ${PROGRAM}_NOT_BUILT)
  return()
endif()

# The full names of the program's cases.
function(kilolux_cases program out)
  execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE " *#[^\n]*" "" lines "${lines}")  # the texts of parameters
  string(REGEX MATCHALL "[^\n]+" lines "${lines}")
  set(cases "")
  foreach(line IN LISTS lines)
    if(line MATCHES "^  (.+)")
      list(APPEND cases "${suite}${CMAKE_MATCH_1}")
    elseif(line MATCHES "\\.$")
      set(suite "${line}")
    endif()
  endforeach()
  set(${out} "${cases}" PARENT_SCOPE)
endfunction()

# The filters of the entries.
function(kilolux_filters cases entry out)
  set(filters "")
  foreach(case IN LISTS cases)
    string(REGEX MATCH "${entry}" start "${case}")
    if(start STREQUAL case)
      list(APPEND filters "${case}")
    elseif(start)
      list(APPEND filters "${start}*")
    else()
      message(FATAL_ERROR "${case}: in no entry '${entry}'")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES filters)
  set(${out} "${filters}" PARENT_SCOPE)
endfunction()

# An entry is skipped when all of its cases are. Google Test lists the skipped cases last, unless one failed.
set(skipped "\\[  PASSED  \\] 0 tests\\.\n+(\\[  SKIPPED \\][^\n]*\n+)+$")

if(NOT EXISTS ${LIST} OR ${PROGRAM} IS_NEWER_THAN ${LIST} OR ${CMAKE_CURRENT_LIST_FILE} IS_NEWER_THAN ${LIST}
   OR ${CMAKE_PARENT_LIST_FILE} IS_NEWER_THAN ${LIST})
  kilolux_cases(${PROGRAM} cases)
  if(ELSEWHERE)
    list(FILTER cases EXCLUDE REGEX "${ELSEWHERE}")
  endif()
  kilolux_filters("${cases}" "${ENTRY}" filters)
  set(text "")
  foreach(filter IN LISTS filters)
    string(APPEND text "add_test([==[${PREFIX}${filter}]==] [==[${PROGRAM}]==] --gtest_filter=${filter})\n"
      "set_tests_properties([==[${PREFIX}${filter}]==] PROPERTIES SKIP_REGULAR_EXPRESSION [==[${skipped}]==]")
    foreach(word IN LISTS PROPERTIES)
      string(APPEND text " [==[${word}]==]")
    endforeach()
    if("${PREFIX}${filter}" MATCHES "${SERIAL}")
      string(APPEND text " RUN_SERIAL TRUE")
    endif()
    string(APPEND text ")\n")
    if(UNIT AND filter MATCHES "${UNIT}")
      string(APPEND text "set_tests_properties([==[${PREFIX}${filter}]==] PROPERTIES LABELS [==[${FOLDER};unit]==])\n")
    endif()
  endforeach()
  file(WRITE ${LIST} "${text}")
endif()
include(${LIST})
