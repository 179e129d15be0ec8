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
foreach(suite ${suites})
  string(REGEX REPLACE "\\.$" "" test "${GROUP}.${suite}")
  string(APPEND lines "add_test([==[${test}]==] [==[${PROGRAM}]==] --gtest_filter=${suite}*)\n"
                      "set_tests_properties([==[${test}]==] PROPERTIES LABELS unit TIMEOUT ${TIMEOUT}\n"
                      "                     SKIP_RETURN_CODE 77)\n")
endforeach()
file(WRITE ${LIST} "${lines}")
