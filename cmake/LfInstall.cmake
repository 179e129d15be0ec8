# SPDX-License-Identifier: Apache-2.0
# Defines what `cmake --install` installs: the library as one archive with the headers that it promises, for CMake's
# find_package(lfrendertools) and for pkg-config; the programs; their documentation.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(folders GLOBAL PROPERTY LF_FOLDERS)
list(TRANSFORM folders REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
add_library(lf_installed STATIC ${objects})
set_target_properties(lf_installed PROPERTIES OUTPUT_NAME lfrendertools EXPORT_NAME lfrendertools
                                              LINKER_LANGUAGE CXX)
target_compile_features(lf_installed PUBLIC cxx_std_20)
# Inline functions of the headers must compute the same bits (cmake/LfFolder.cmake).
target_compile_options(lf_installed INTERFACE -ffp-contract=off)
target_include_directories(lf_installed INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
# An archive does not contain the libraries that it needs, so its user links them. Those without a namespace are linked by
# name, so that their user needs no CMake packages of them.
target_link_libraries(lf_installed PUBLIC Eigen3::Eigen fmt::fmt TBB::tbb Threads::Threads yaml-cpp
                                          hwy::hwy OpenEXR::OpenEXR OpenEXR::OpenEXRCore png tiff z raw_r jpeg lcms2
                                           simdjson zstd xxhash sqlite3 icuuc pugixml ${LF_OCIO_NAME}
                                           ${LF_PICTURE_LIBRARIES} ${CMAKE_DL_LIBS})
install(TARGETS lf_installed EXPORT lfrendertoolsTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})

# The headers are made with the archive, because some of them have other places than in the source.
set(LF_INSTALLED_HEADERS ${PROJECT_BINARY_DIR}/installed_headers)
set(script ${PROJECT_SOURCE_DIR}/cmake/installed_headers.cmake)
file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lf/*.h)
add_custom_command(OUTPUT ${LF_INSTALLED_HEADERS}.made
                   COMMAND ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D OUT=${LF_INSTALLED_HEADERS} -P ${script}
                   COMMAND ${CMAKE_COMMAND} -E touch ${LF_INSTALLED_HEADERS}.made
                   DEPENDS ${headers} ${PROJECT_SOURCE_DIR}/lf/public_headers.txt ${script}
                   COMMENT "Making the headers of the library" VERBATIM)
add_custom_target(lf_installed_headers DEPENDS ${LF_INSTALLED_HEADERS}.made)
add_dependencies(lf_installed lf_installed_headers)
install(DIRECTORY ${LF_INSTALLED_HEADERS}/lf DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lfrendertools)
install(EXPORT lfrendertoolsTargets NAMESPACE lfrendertools:: DESTINATION ${package_folder})
configure_package_config_file(cmake/lfrendertoolsConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/lfrendertoolsConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lfrendertoolsConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lfrendertoolsConfig.cmake
              ${PROJECT_BINARY_DIR}/lfrendertoolsConfigVersion.cmake
        DESTINATION ${package_folder})
# The path from the .pc file to the prefix, so that an installation can be moved.
string(REGEX REPLACE "[^/]+" ".." LF_PC_UP "${CMAKE_INSTALL_LIBDIR}")
if(LF_OCIO_NAME)
  set(LF_PC_OCIO -l${LF_OCIO_NAME})
endif()
list(TRANSFORM LF_PICTURE_LIBRARIES PREPEND -l OUTPUT_VARIABLE LF_PC_PICTURES)
list(JOIN LF_PC_PICTURES " " LF_PC_PICTURES)
configure_file(cmake/lfrendertools.pc.in lfrendertools.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lfrendertools.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

get_property(tools GLOBAL PROPERTY LF_TOOLS)
install(TARGETS ${tools} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(LF_PROGRAM_PAGES)
  install(DIRECTORY ${LF_PROGRAM_PAGES}/share/man/ DESTINATION ${CMAKE_INSTALL_MANDIR})
  install(DIRECTORY ${LF_PROGRAM_PAGES}/share/bash-completion ${LF_PROGRAM_PAGES}/share/zsh ${LF_PROGRAM_PAGES}/share/fish
          DESTINATION ${CMAKE_INSTALL_DATADIR})
  install(FILES ${LF_PROGRAM_PAGES}/programs.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/doc)
endif()
install(FILES README.md CHANGELOG.md LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Pages link to the schemas, and editors name them by a path that does not change.
install(DIRECTORY doc examples schemas DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN doc/figures EXCLUDE)
install(DIRECTORY schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/lfrendertools)
