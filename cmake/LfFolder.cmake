# SPDX-License-Identifier: Apache-2.0
# The compiler settings of everything we compile. -ffp-contract=off: the same bits on every
# target need that no multiply-add is fused behind our back (doc/ray.md, "Same bits").
add_library(lf_options INTERFACE)
target_compile_features(lf_options INTERFACE cxx_std_20)
target_compile_options(lf_options INTERFACE -ffp-contract=off -Wall -Wextra -Wshadow
                                            -Wnon-virtual-dtor)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 warns falsely of std::string, depending on what it inlines (its bugs 105329 and 105651).
  target_compile_options(lf_options INTERFACE -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow
                                              -Wno-stringop-overread)
endif()
target_include_directories(lf_options INTERFACE ${PROJECT_SOURCE_DIR})
# All targets are compiled with -fPIC, although only the Python package needs it: they share precompiled headers.
target_compile_options(lf_options INTERFACE -fPIC)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC looks for unused memory less often, which saves a tenth of its time and takes 0.1 GB more: each search goes
  # through all precompiled headers.
  target_compile_options(lf_options INTERFACE --param=ggc-min-heapsize=500000)
endif()
if(LF_WERROR)
  target_compile_options(lf_options INTERFACE -Werror)
endif()
if(LF_SANITIZE)
  target_compile_options(lf_options INTERFACE -fsanitize=${LF_SANITIZE} -fno-omit-frame-pointer
                                              -fno-sanitize-recover=all)
  target_link_options(lf_options INTERFACE -fsanitize=${LF_SANITIZE})
endif()
if(LF_SCALAR)
  target_compile_definitions(lf_options INTERFACE HWY_COMPILE_ONLY_SCALAR)
elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
  # The compiler does not know the length of SVE's vectors, which the kernels need; they use NEON.
  target_compile_definitions(lf_options INTERFACE
                             "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
endif()
if(LF_COVERAGE)
  # Threads count at the same time. Absolute paths, because ccache runs the compiler in any folder.
  target_compile_options(lf_options INTERFACE --coverage -fprofile-update=atomic -fprofile-abs-path)
  target_link_options(lf_options INTERFACE --coverage)
endif()
if(LF_FUZZ)
  # Coverage for libFuzzer everywhere; the fuzz targets alone link its main.
  target_compile_options(lf_options INTERFACE -fsanitize=fuzzer-no-link)
  target_link_options(lf_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# The presets compile the sources of a folder together, twelve at a time, which takes half the time: names in anonymous
# namespaces must differ within a folder. The dev preset alone compiles one source at a time.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC would warn where a class of a header has members whose types only its source knows (an anonymous namespace).
  target_compile_options(lf_options INTERFACE -Wno-subobject-linkage)
endif()

include(LfPrecompiled)

# The umbrella users link.
add_library(lfrendertools INTERFACE)
add_library(lfrendertools::lfrendertools ALIAS lfrendertools)

# lf_folder(path [WORDS] SOURCES ... [ALONE ...] DEPENDS ... [LIBS ...] [PUBLIC_LIBS ...] [TESTS ...]
#           [TEST_LIBS ...] [FUZZ ...] [BENCH ...])
#
# The folder lf/<path> as a static library: lf_camera for camera, lf_camera_path for camera/path.
#   WORDS        the sources read and write texts, and do nothing for each pixel or ray (lf_precompile)
#   SOURCES      the .cc files
#   ALONE        .cc files among SOURCES that are not compiled together with others: kernels, which include themselves
#                once for each instruction set, and files that share names with others on purpose
#   DEPENDS      the folders it may include, as paths (doc/layout.md; checked by scripts/house/include_rules.py)
#   LIBS         third-party targets its .cc files need;  PUBLIC_LIBS: its headers too
#   TESTS        x_test.cc files: one program per folder, each of its suites a test of ctest, named
#                camera.Suite or camera.path.Suite
#   FUZZ         x_fuzz.cc files: libFuzzer programs with LF_FUZZ, and in every build a replay of
#                fuzz/corpus/<x>/ as a test
#   BENCH        x_bench.cc files, built with LF_BENCH
function(lf_folder path)
  cmake_parse_arguments(F "WORDS" "" "SOURCES;ALONE;DEPENDS;LIBS;PUBLIC_LIBS;TESTS;TEST_LIBS;FUZZ;BENCH"
                        ${ARGN})
  if(F_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "lf_folder(${path}): unknown words: ${F_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT CMAKE_CURRENT_SOURCE_DIR STREQUAL "${PROJECT_SOURCE_DIR}/lf/${path}")
    message(FATAL_ERROR "lf_folder(${path}) stands in ${CMAKE_CURRENT_SOURCE_DIR}")
  endif()
  string(REPLACE "/" "_" name ${path})
  list(TRANSFORM F_DEPENDS REPLACE "/" "_")
  list(TRANSFORM F_DEPENDS PREPEND lf_)
  set(target lf_${name})
  if(F_SOURCES)
    add_library(${target} STATIC ${F_SOURCES})
    set_property(GLOBAL APPEND PROPERTY LF_FOLDERS ${target})
    target_link_libraries(${target} PUBLIC lf_options Eigen3::Eigen ${F_DEPENDS} ${F_PUBLIC_LIBS}
                                    PRIVATE ${F_LIBS})
    if(F_WORDS)
      lf_precompile(${target} words)
    else()
      lf_precompile(${target})
    endif()
    if(F_ALONE)
      set_source_files_properties(${F_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE lf_options Eigen3::Eigen ${F_DEPENDS})
  endif()
  add_library(lf::${name} ALIAS ${target})
  target_link_libraries(lfrendertools INTERFACE ${target})

  if(LF_TESTS AND F_TESTS)
    add_executable(${target}_test ${F_TESTS})
    target_link_libraries(${target}_test PRIVATE ${target} ${F_TEST_LIBS} lf_unit_main)
    lf_precompile(${target}_test test)
    string(REPLACE "/" "." group ${path})
    lf_unit_tests(${target}_test ${group})
  endif()
  foreach(fuzz_source ${F_FUZZ})
    lf_fuzz(${target} ${fuzz_source})
  endforeach()
  if(LF_BENCH AND F_BENCH)
    find_package(benchmark REQUIRED)
    add_executable(${target}_bench ${F_BENCH})
    target_link_libraries(${target}_bench PRIVATE ${target} benchmark::benchmark_main)
  endif()
endfunction()

# x_fuzz.cc -> program x_fuzz, and a test that replays fuzz/corpus/x/.
function(lf_fuzz target source)
  get_filename_component(fuzz_target ${source} NAME_WE)
  string(REGEX REPLACE "_fuzz$" "" subject ${fuzz_target})
  set(corpus ${PROJECT_SOURCE_DIR}/fuzz/corpus/${subject})
  if(LF_FUZZ)
    add_executable(${fuzz_target} ${source})
    target_link_options(${fuzz_target} PRIVATE -fsanitize=fuzzer)
    target_link_libraries(${fuzz_target} PRIVATE ${target})
  elseif(LF_TESTS)
    add_executable(${fuzz_target} ${source})
    target_link_libraries(${fuzz_target} PRIVATE lf_replay_main ${target})
    lf_test(fuzz.${subject}_replays_its_corpus COMMAND ${fuzz_target} ${corpus} LABELS unit
            NEEDS ${fuzz_target})
  endif()
endfunction()

# The target that builds every program.
add_custom_target(programs)

# lf_tool(name [LIBS ...]): the program tools/<name>.cc. LIBS names the folders of lf/ that it needs besides those of
# lf_tool_common, so that a program is built without the folders of the others.
function(lf_tool name)
  cmake_parse_arguments(T "" "" "LIBS" ${ARGN})
  add_executable(${name} ${name}.cc)
  set_property(GLOBAL APPEND PROPERTY LF_TOOLS ${name})
  add_dependencies(programs ${name})
  target_link_libraries(${name} PRIVATE lf_tool_common ${T_LIBS})
  lf_precompile(${name} words)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endfunction()
