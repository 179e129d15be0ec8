# SPDX-License-Identifier: Apache-2.0
# The visualiser's page: TypeScript in web/, bundled by esbuild and embedded in lfvisualizer.
#
# LF_PAGE is the folder of the bundled page. It is empty if the page cannot be built, without Node.js 18 and npm or
# without their packages. lfvisualizer then reports this; nothing else changes. A release brings the page along, bundled
# in web/bundled/ (scripts/release_tarball.sh), and needs neither Node.js nor npm nor a network.
option(LF_WEB "Build the visualiser's page (needs Node.js 18 and npm, or a page bundled before)" ON)
set(LF_PAGE_DIR "" CACHE PATH "Folder of a page bundled before; default: web/bundled, unless npm has installed packages")
set(LF_PAGE "")
set(LF_PAGE_IS_BUILT OFF)
set(page_names index.html page.js page.css)
if(LF_WEB AND LF_VISUALIZER)
  set(web ${PROJECT_SOURCE_DIR}/web)
  # npm writes this file when it has installed the packages of package-lock.json.
  set(installed ${web}/node_modules/.package-lock.json)
  set(bundled ${LF_PAGE_DIR})
  if(NOT bundled AND EXISTS ${web}/bundled AND NOT EXISTS ${installed})
    set(bundled ${web}/bundled)
  endif()
  find_program(LF_NODE NAMES node nodejs)
  find_program(LF_NPM npm)
  if(bundled)
    foreach(name ${page_names})
      if(NOT EXISTS ${bundled}/${name})
        message(FATAL_ERROR "${bundled} lacks ${name}: a bundled page has index.html, page.js and page.css. Make it by "
                            "node web/build.mjs FOLDER, and name the folder by -DLF_PAGE_DIR=FOLDER")
      endif()
    endforeach()
    message(STATUS "The visualiser's page is taken as bundled in ${bundled}")
    set(LF_PAGE ${bundled})
  elseif(LF_NODE AND LF_NPM)
    if(NOT EXISTS ${installed} OR ${web}/package-lock.json IS_NEWER_THAN ${installed})
      message(STATUS "Installing the page's packages by npm")
      execute_process(COMMAND ${LF_NPM} ci --no-fund --no-audit --loglevel=error
                      WORKING_DIRECTORY ${web} RESULT_VARIABLE status ERROR_VARIABLE complaint
                      OUTPUT_QUIET)
      if(NOT status EQUAL 0)
        message(WARNING "npm cannot install the visualiser's page, which is left out:\n${complaint}")
      else()
        file(TOUCH ${installed})
      endif()
    endif()
    if(EXISTS ${installed})
      set(LF_PAGE ${PROJECT_BINARY_DIR}/page)
      set(LF_PAGE_IS_BUILT ON)
    endif()
  else()
    message(WARNING "Node.js or npm is missing: lfvisualizer is built without its page")
  endif()
endif()

if(LF_PAGE)
  list(TRANSFORM page_names PREPEND ${LF_PAGE}/ OUTPUT_VARIABLE LF_PAGE_FILES)
  add_custom_target(lf_page DEPENDS ${LF_PAGE_FILES})
endif()
if(LF_PAGE_IS_BUILT)
  file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS ${web}/src/*.ts ${web}/src/*.css ${web}/src/*.html)
  add_custom_command(
    OUTPUT ${LF_PAGE_FILES}
    COMMAND ${LF_NODE} ${web}/build.mjs ${LF_PAGE}
    DEPENDS ${page_sources} ${web}/build.mjs ${web}/package-lock.json
    COMMENT "Bundling the visualiser's page"
    VERBATIM)
endif()
