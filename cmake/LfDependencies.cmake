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

# Optional: formats of image files (doc/formats/images.md). Small libraries are linked. Those that load many others are
# loaded when the first file needs them (lf/core/loaded_library.h), and only their headers are used here.
add_library(lf_picture_libraries INTERFACE)
target_link_libraries(lf_picture_libraries INTERFACE ${CMAKE_DL_LIBS})
set(LF_PICTURE_LIBRARIES)  # names of those that are linked

# lf_find_picture_library(KEY FORMAT HEADER LIBRARY [FOLDERS...])  sets LF_KEY_INCLUDE and LF_KEY_LIBRARY, and FOUND_KEY
function(lf_find_picture_library key format header library)
  find_path(LF_${key}_INCLUDE ${header} PATH_SUFFIXES ${ARGN})
  find_library(LF_${key}_LIBRARY ${library} PATH_SUFFIXES ${ARGN})
  if(LF_${key}_INCLUDE AND LF_${key}_LIBRARY)
    set(FOUND_${key} TRUE PARENT_SCOPE)
    target_include_directories(lf_picture_libraries SYSTEM INTERFACE ${LF_${key}_INCLUDE})
  else()
    message(STATUS "${library} is missing: the programs are built without ${format} files")
  endif()
endfunction()

# lf_link_picture_library(KEY LIBRARY)  links a library that was found, and defines LF_HAS_KEY
macro(lf_link_picture_library key library)
  if(FOUND_${key})
    target_link_libraries(lf_picture_libraries INTERFACE ${LF_${key}_LIBRARY})
    target_compile_definitions(lf_picture_libraries INTERFACE LF_HAS_${key})
    list(APPEND LF_PICTURE_LIBRARIES ${library})
  endif()
endmacro()

# lf_define_library_name(TARGET KEY)  defines LF_KEY_LIBRARY_NAME, the file that LF_KEY_LIBRARY is loaded from: its SONAME
function(lf_define_library_name target key)
  execute_process(COMMAND ${CMAKE_OBJDUMP} -p ${LF_${key}_LIBRARY} OUTPUT_VARIABLE headers ERROR_QUIET)
  if(headers MATCHES "SONAME +([^ \n]+)")
    target_compile_definitions(${target} INTERFACE LF_${key}_LIBRARY_NAME="${CMAKE_MATCH_1}")
  else()
    message(STATUS "${LF_${key}_LIBRARY} has no SONAME: the programs are built without it")
  endif()
endfunction()

# lf_load_picture_library(KEY)  lets a library be loaded when the first file needs it
function(lf_load_picture_library key)
  if(FOUND_${key})
    lf_define_library_name(lf_picture_libraries ${key})
  endif()
endfunction()

lf_find_picture_library(WEBP WebP webp/decode.h webp)
lf_link_picture_library(WEBP webp)
lf_find_picture_library(OPENJPEG "JPEG 2000" openjpeg.h openjp2 openjpeg-2.5)
lf_load_picture_library(OPENJPEG)
lf_find_picture_library(JXL "JPEG XL" jxl/decode.h jxl)
lf_load_picture_library(JXL)
lf_find_picture_library(HEIF HEIF libheif/heif.h heif)
lf_load_picture_library(HEIF)
lf_find_picture_library(HDF5 HDF5 hdf5.h hdf5 hdf5/serial)
lf_load_picture_library(HDF5)

# Optional: light fields on web servers. libcurl, which loads 30 others, is loaded when the first is opened.
find_path(LF_CURL_INCLUDE curl/curl.h)
find_library(LF_CURL_LIBRARY NAMES curl curl-gnutls)
add_library(lf_curl INTERFACE)
if(LF_CURL_INCLUDE AND LF_CURL_LIBRARY)
  target_include_directories(lf_curl SYSTEM INTERFACE ${LF_CURL_INCLUDE})
  lf_define_library_name(lf_curl CURL)
else()
  message(STATUS "libcurl is missing: the programs are built without light fields on web servers")
endif()

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
