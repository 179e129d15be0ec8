# SPDX-License-Identifier: Apache-2.0
# Makes man pages, completion for shells and the reference page of the programs: the target program_pages, which is a
# part of `all`. The programs are asked for their description (scripts/program_pages/program_pages.py), so that no page is older than
# its program. LF_PROGRAM_PAGES names the folder; it is empty if the programs cannot be run.
set(LF_PROGRAM_PAGES "")
if(CMAKE_CROSSCOMPILING)
  message(STATUS "No man pages and no completion: the programs for ${CMAKE_SYSTEM_PROCESSOR} cannot be run here")
  return()
endif()
if(NOT Python3_Interpreter_FOUND)
  message(STATUS "No man pages and no completion: they need Python 3 (python3)")
  return()
endif()
set(LF_PROGRAM_PAGES ${PROJECT_BINARY_DIR}/program_pages)
get_property(tools GLOBAL PROPERTY LF_TOOLS)
set(scripts program_pages man_pages shell_completion)
list(TRANSFORM scripts REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/scripts/program_pages/\\1.py")
add_custom_command(
  OUTPUT ${LF_PROGRAM_PAGES}/programs.md
  COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/scripts/program_pages/program_pages.py ${PROJECT_BINARY_DIR}/bin
          ${LF_PROGRAM_PAGES} ${tools}
  DEPENDS ${tools} ${scripts}
  COMMENT "Making man pages and completion of the programs"
  VERBATIM)
add_custom_target(program_pages ALL DEPENDS ${LF_PROGRAM_PAGES}/programs.md)
