# SPDX-License-Identifier: Apache-2.0
# Finds all third-party libraries of the project (doc/design.md, "Dependencies"). A folder names the ones that it needs
# under LIBS.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(nlohmann_json 3 REQUIRED)
find_package(simdjson 3 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(CLI11 2 REQUIRED)
find_package(hwy 1.0 REQUIRED)
find_package(SQLite3 3.40 REQUIRED)
find_package(ICU 72 REQUIRED COMPONENTS uc)
find_package(pugixml 1.13 REQUIRED)
# Debian's packages of these libraries have no files for CMake.
find_path(LF_ZSTD_INCLUDE zstd.h REQUIRED)
find_library(LF_ZSTD_LIBRARY zstd REQUIRED)
add_library(lf_zstd INTERFACE)
target_include_directories(lf_zstd SYSTEM INTERFACE ${LF_ZSTD_INCLUDE})
target_link_libraries(lf_zstd INTERFACE ${LF_ZSTD_LIBRARY})
find_path(LF_XXHASH_INCLUDE xxhash.h REQUIRED)
find_library(LF_XXHASH_LIBRARY xxhash REQUIRED)
add_library(lf_xxhash INTERFACE)
target_include_directories(lf_xxhash SYSTEM INTERFACE ${LF_XXHASH_INCLUDE})
target_link_libraries(lf_xxhash INTERFACE ${LF_XXHASH_LIBRARY})
# A library of headers only.
find_path(LF_NANOFLANN_INCLUDE nanoflann.hpp REQUIRED)
# libjpeg-turbo; another library cannot decode a part of an image, and the compiler will report it.
find_package(JPEG REQUIRED)
if(LF_VISUALIZER)
  # libmicrohttpd only has a file for pkg-config.
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(LF_MICROHTTPD REQUIRED IMPORTED_TARGET libmicrohttpd>=0.9.75)
endif()
if(LF_TESTS)
  find_package(GTest REQUIRED)
endif()

# Image files are read and written by the library of each format. One library for all formats, OpenImageIO, would load
# 250 further libraries into every program, which takes half a second and 120 MiB.
find_package(PNG 1.6 REQUIRED)
find_package(TIFF 4.5 REQUIRED)
find_package(OpenEXR 3.1 REQUIRED CONFIG)
find_package(ZLIB REQUIRED)

# libraw_r is LibRaw's library for several threads: several LF images are decoded at the same time.
find_path(LF_LIBRAW_INCLUDE libraw/libraw.h REQUIRED)
find_library(LF_LIBRAW_LIBRARY raw_r REQUIRED)
add_library(lf_libraw INTERFACE)
target_include_directories(lf_libraw SYSTEM INTERFACE ${LF_LIBRAW_INCLUDE})
target_link_libraries(lf_libraw INTERFACE ${LF_LIBRAW_LIBRARY})

# Little CMS converts the colour profiles of photographs.
find_path(LF_LCMS_INCLUDE lcms2.h REQUIRED)
find_library(LF_LCMS_LIBRARY lcms2 REQUIRED)
add_library(lf_lcms INTERFACE)
target_include_directories(lf_lcms SYSTEM INTERFACE ${LF_LCMS_INCLUDE})
target_link_libraries(lf_lcms INTERFACE ${LF_LCMS_LIBRARY})

# Optional: display views of frames (--view).
find_path(LF_OCIO_INCLUDE OpenColorIO/OpenColorIO.h)
find_library(LF_OCIO_LIBRARY OpenColorIO)
add_library(lf_ocio INTERFACE)
if(LF_OCIO_INCLUDE AND LF_OCIO_LIBRARY)
  target_include_directories(lf_ocio SYSTEM INTERFACE ${LF_OCIO_INCLUDE})
  target_link_libraries(lf_ocio INTERFACE ${LF_OCIO_LIBRARY})
  target_compile_definitions(lf_ocio INTERFACE LF_HAS_OCIO)
  set(LF_OCIO_NAME OpenColorIO)
else()
  message(STATUS "OpenColorIO is missing: lfrenderer and lfmerge are built without --view")
endif()

# Debian's Python has the modules that tests use; another Python on the PATH may lack them.
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
if(LF_TESTS OR LF_PYTHON)
  find_package(Python3 REQUIRED COMPONENTS Interpreter OPTIONAL_COMPONENTS Development.Module)
else()
  find_package(Python3 COMPONENTS Interpreter)  # makes man pages
endif()
if(LF_PYTHON)
  find_package(pybind11 2.10 CONFIG)
endif()
