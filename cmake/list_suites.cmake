# SPDX-License-Identifier: Apache-2.0
# Writes the suites of a GoogleTest program as tests of ctest, GROUP.Suite. Run when the program is built:
#
#   cmake -D PROGRAM=... -D GROUP=... -D TIMEOUT=SECONDS -D LIST=FILE -P list_suites.cmake
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE names RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests ended with ${status}:\n${names}")
endif()
# A suite is a line without indentation, such as "Distortion.".
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." suites "${names}")
list(TRANSFORM suites STRIP)
set(lines "")
# A suite of which a test was skipped counts as skipped, so that ctest names it. Failures come after skipped tests in
# the output: the expression does not match if there are any.
foreach(suite ${suites})
  string(REGEX REPLACE "\\.$" "" test "${GROUP}.${suite}")
  string(APPEND lines "add_test([==[${test}]==] [==[${PROGRAM}]==] --gtest_filter=${suite}*)\n"
                      "set_tests_properties([==[${test}]==] PROPERTIES LABELS unit TIMEOUT ${TIMEOUT}\n"
                      "                     SKIP_REGULAR_EXPRESSION [==[\\[  SKIPPED \\] [^\n]+\n*$]==])\n")
endforeach()
file(WRITE ${LIST} "${lines}")
