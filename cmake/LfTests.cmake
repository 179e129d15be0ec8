# SPDX-License-Identifier: Apache-2.0
# Defines how tests are told to ctest. Each test has a time limit, and labels to choose it by (ctest -L):
#   unit      the C++ tests of one folder, and fuzz targets that replay their corpus
#   program   whole programs
#   page      lfvisualizer and its page
#   cluster   a Slurm on this machine
#   slow      takes more than a minute on two cores
#   house     rules about the files themselves; nothing is built for them
#
# All tests may run at the same time: each has a folder of its own, and ports are chosen by the system.

# A time limit is several times what the test takes on two busy cores, in a release build.
set(LF_TIMEOUT_FACTOR "" CACHE STRING "Multiplies the time limits of tests; default: by the kind of build")
set(LF_TEST_PATIENCE 1)
if(LF_TIMEOUT_FACTOR)
  set(LF_TEST_PATIENCE ${LF_TIMEOUT_FACTOR})
elseif(LF_SANITIZE)
  set(LF_TEST_PATIENCE 10)
elseif(NOT CMAKE_BUILD_TYPE STREQUAL Release)
  set(LF_TEST_PATIENCE 4)
endif()
math(EXPR LF_UNIT_TIMEOUT "600 * ${LF_TEST_PATIENCE}")

# lf_needed_by(name target...): the target needed_by_<name> builds what the tests run whose names begin with <name> and
# a dot, or the one test of that name (./test --only).
function(lf_needed_by name)
  if(NOT TARGET needed_by_${name})
    add_custom_target(needed_by_${name})
  endif()
  if(ARGN)
    add_dependencies(needed_by_${name} ${ARGN})
  endif()
endfunction()

# The main functions of unit test programs (a suite with a skipped test and no failed one is shown as skipped), and of
# fuzz targets without libFuzzer. Release builds optimise unit tests less than what they test, which saves a third of the
# time that the tests take to build.
if(LF_TESTS)
  add_library(lf_unit_main STATIC ${PROJECT_SOURCE_DIR}/tests/helpers/unit_main.cc)
  target_link_libraries(lf_unit_main PUBLIC GTest::gtest PRIVATE lf_options)
  target_compile_options(lf_unit_main INTERFACE $<$<CONFIG:Release>:-O1>)
  add_library(lf_replay_main STATIC ${PROJECT_SOURCE_DIR}/fuzz/replay_main.cc)
  target_link_libraries(lf_replay_main PRIVATE lf_options)
endif()

# lf_unit_tests(target group): each suite of the program is a test of ctest, group.Suite. The group of lf/camera/path
# is camera.path, which is also built where all tests of camera are.
#
# A suite and not a single test is a process, because thousands of processes would take longer than their tests.
function(lf_unit_tests target group)
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
  add_custom_command(
    TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:${target}> -D GROUP=${group} -D TIMEOUT=${LF_UNIT_TIMEOUT}
            -D LIST=${list} -P ${PROJECT_SOURCE_DIR}/cmake/list_suites.cmake
    BYPRODUCTS ${list}
    VERBATIM)
  # A program that was not built is a test that fails.
  set(included ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake)
  file(WRITE ${included} "if(EXISTS [==[${list}]==])\n  include([==[${list}]==])\nelse()\n"
                         "  add_test(${group}.is_not_built ${target})\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${included})
  lf_needed_by(${group} ${target})
  if(group MATCHES "^([^.]+)\\.")
    lf_needed_by(${CMAKE_MATCH_1} ${target})
  endif()
endfunction()

# lf_test(group.name COMMAND word... LABELS label... [TIMEOUT seconds] [NEEDS target...])
#
# A test that is one command. Exit code 77 says that it was skipped. The default time limit is 120 s.
function(lf_test name)
  cmake_parse_arguments(T "" "TIMEOUT" "COMMAND;LABELS;NEEDS" ${ARGN})
  if(T_UNPARSED_ARGUMENTS OR NOT T_LABELS)
    message(FATAL_ERROR "lf_test(${name}): unknown words or no LABELS: ${T_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 120)
  endif()
  math(EXPR timeout "${T_TIMEOUT} * ${LF_TEST_PATIENCE}")
  add_test(NAME ${name} COMMAND ${T_COMMAND})
  set_tests_properties(${name} PROPERTIES LABELS "${T_LABELS}" TIMEOUT ${timeout} SKIP_RETURN_CODE 77)
  string(REGEX REPLACE "\\..*" "" group ${name})
  lf_needed_by(${group} ${T_NEEDS})
  lf_needed_by(${name} ${T_NEEDS})
endfunction()

# lf_program_test(tests.name word... [SCRIPT file] [SLOW] [LABELS label...])
#
# A test of whole programs: the Python script <name>_test.py in one of the folders of tests/, which tests/run_test.py
# runs, or the script of SCRIPT. A word that names a target is replaced by the path of its file; PROGRAMS, by the folder
# of all programs. The time limit is 900 s, that of a SLOW test 3600 s. LABELS are those besides program and slow.
function(lf_program_test name)
  cmake_parse_arguments(P "SLOW" "SCRIPT" "LABELS" ${ARGN})
  set(words "")
  set(needs "")
  foreach(word ${P_UNPARSED_ARGUMENTS})
    if(word STREQUAL PROGRAMS)
      list(APPEND words ${PROJECT_BINARY_DIR}/bin)
      list(APPEND needs programs)
    elseif(TARGET ${word})
      list(APPEND words $<TARGET_FILE:${word}>)
      list(APPEND needs ${word})
    else()
      list(APPEND words ${word})
    endif()
  endforeach()
  if(P_SCRIPT)
    cmake_path(ABSOLUTE_PATH P_SCRIPT BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
  else()
    string(REGEX REPLACE "^tests\\." "" P_SCRIPT ${name})
    set(P_SCRIPT ${CMAKE_CURRENT_SOURCE_DIR}/run_test.py ${P_SCRIPT})
  endif()
  set(timeout 900)
  set(cost 10)  # what costs most begins first, so that no processor waits for a last long test
  if(P_SLOW)
    set(timeout 3600)
    set(cost 100)
    list(APPEND P_LABELS slow)
  endif()
  lf_test(${name} COMMAND ${Python3_EXECUTABLE} ${P_SCRIPT} ${words} LABELS program ${P_LABELS}
          TIMEOUT ${timeout} NEEDS ${needs})
  set_tests_properties(${name} PROPERTIES COST ${cost})
endfunction()

# lf_house_test(house.name script [argument...]): a script in scripts/ or tests/ that looks at files.
function(lf_house_test name script)
  set(interpreter "")
  if(script MATCHES "\\.py$")
    set(interpreter ${Python3_EXECUTABLE})
  endif()
  lf_test(${name} COMMAND ${interpreter} ${PROJECT_SOURCE_DIR}/${script} ${ARGN} LABELS house)
endfunction()

# lf_all_tests_have_limits(): an error for a test of this folder that add_test made without a limit.
function(lf_all_tests_have_limits)
  get_property(names DIRECTORY PROPERTY TESTS)
  foreach(name ${names})
    get_property(is_limited TEST ${name} PROPERTY TIMEOUT SET)
    if(NOT is_limited)
      message(SEND_ERROR "The test ${name} has no time limit and no label: define it by a function of "
                         "cmake/LfTests.cmake")
    endif()
  endforeach()
endfunction()
