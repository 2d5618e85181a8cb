# SPDX-License-Identifier: Apache-2.0
# Runs the one test FILTER of TESTS (a Google Test program) under OCLGRIND; fails on any report and if the test fails. For correct reports
# oclgrind 21.10 needs:
# - no optimisation: it lacks intrinsics that its compiler then makes, and considers values uninitialised that the
#   optimiser left undefined on purpose;
# - one test a process: it considers reused buffers uninitialised;
# - at most 8 lanes: it considers vectors of 16 uninitialised in the arguments of functions;
# - no check for uninitialised values (UNINITIALIZED empty) where kernels use float3: the check crashes on shuffles
#   that widen vectors, which its compiler makes of them;
# - the result of the tests, not of the process: it crashes at exit when programs live as long as the process.
set(log ${CMAKE_CURRENT_BINARY_DIR}/oclgrind_${FILTER}.log)
file(REMOVE ${log})
execute_process(
  COMMAND ${OCLGRIND} --build-options -cl-opt-disable --data-races ${UNINITIALIZED} --check-api --max-errors 20
          --log ${log} ${TESTS} --gtest_filter=${FILTER}
  OUTPUT_VARIABLE output ERROR_VARIABLE output)
message("${output}")
if(NOT EXISTS ${log})
  message(FATAL_ERROR "oclgrind did not run")
endif()
file(READ ${log} reports)
string(STRIP "${reports}" reports)
if(reports)
  message(FATAL_ERROR "oclgrind reports:\n${reports}")
endif()
if(output MATCHES "FAILED" OR NOT output MATCHES "PASSED  . 1 test")
  message(FATAL_ERROR "${FILTER} fails under oclgrind")
endif()
