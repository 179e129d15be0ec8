# SPDX-License-Identifier: Apache-2.0
# The headers that most sources include are parsed once for all targets, which saves a third of a build. They are
# those of the standard library and of other projects alone: a change of our own headers builds their users only.
#
# A source still includes what it uses: the dev preset builds without this (LF_PRECOMPILED=OFF).
option(LF_PRECOMPILED "Parse the headers that most sources include once for all" ON)

set(LF_PRECOMPILED_HEADERS
    <algorithm> <array> <atomic> <charconv> <chrono> <cmath> <cstdint> <cstring> <filesystem> <fstream>
    <functional> <limits> <map> <memory> <mutex> <numeric> <optional> <set> <span> <string> <string_view>
    <system_error> <thread> <utility> <vector> <fmt/format.h> <fmt/ranges.h> <Eigen/Geometry>)

if(LF_PRECOMPILED)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(lf_options INTERFACE -fpch-preprocess)  # without it ccache keeps nothing
  endif()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled.cc CONTENT "// The headers are all there is.\n")
  add_library(lf_precompiled OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled.cc)
  target_link_libraries(lf_precompiled PRIVATE lf_options Eigen3::Eigen fmt::fmt)
  target_precompile_headers(lf_precompiled PRIVATE ${LF_PRECOMPILED_HEADERS})
  if(LF_TESTS)
    add_library(lf_precompiled_test OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled.cc)
    target_link_libraries(lf_precompiled_test PRIVATE lf_options lf_unit_main Eigen3::Eigen fmt::fmt)
    target_precompile_headers(lf_precompiled_test PRIVATE ${LF_PRECOMPILED_HEADERS} <gtest/gtest.h>)
  endif()
  if(CMAKE_BUILD_TYPE STREQUAL Release)  # the compiler takes precompiled headers only for the same -O
    add_library(lf_precompiled_words OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled.cc)
    target_compile_options(lf_precompiled_words PRIVATE -O1)
    target_link_libraries(lf_precompiled_words PRIVATE lf_options Eigen3::Eigen fmt::fmt)
    target_precompile_headers(lf_precompiled_words PRIVATE ${LF_PRECOMPILED_HEADERS})
  endif()
endif()

# lf_precompile(target [test|words]): the target takes the precompiled headers.
#   test   with gtest
#   words  for sources that read and write texts, and do nothing for each pixel or ray: a release build compiles them with
#          -O1, which saves a third of their compile time
function(lf_precompile target)
  set(of lf_precompiled)
  if("test" IN_LIST ARGN)
    set(of lf_precompiled_test)
  elseif("words" IN_LIST ARGN AND CMAKE_BUILD_TYPE STREQUAL Release)
    target_compile_options(${target} PRIVATE -O1)
    set(of lf_precompiled_words)
  endif()
  if(LF_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM ${of})
  endif()
endfunction()
