# The visualiser's page: TypeScript in web/, bundled by esbuild and embedded in lfvisualizer.
#
# LF_PAGE is the folder of the bundled page. It is empty if the page cannot be built, without Node.js 18 and npm or
# without their packages. lfvisualizer then reports this; nothing else changes.
option(LF_WEB "Build the visualiser's page (needs Node.js 18 and npm)" ON)
set(LF_PAGE "")
if(LF_WEB AND LF_VISUALIZER)
  find_program(LF_NODE NAMES node nodejs)
  find_program(LF_NPM npm)
  set(web ${PROJECT_SOURCE_DIR}/web)
  if(LF_NODE AND LF_NPM)
    # npm writes this file when it has installed the packages of package-lock.json.
    set(installed ${web}/node_modules/.package-lock.json)
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
    endif()
  else()
    message(WARNING "Node.js or npm is missing: lfvisualizer is built without its page")
  endif()
endif()

if(LF_PAGE)
  file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS ${web}/src/*.ts ${web}/src/*.css ${web}/src/*.html)
  set(LF_PAGE_FILES ${LF_PAGE}/index.html ${LF_PAGE}/page.js ${LF_PAGE}/page.css)
  add_custom_command(
    OUTPUT ${LF_PAGE_FILES}
    COMMAND ${LF_NODE} ${web}/build.mjs ${LF_PAGE}
    DEPENDS ${page_sources} ${web}/build.mjs ${web}/package-lock.json
    COMMENT "Bundling the visualiser's page"
    VERBATIM)
  add_custom_target(lf_page DEPENDS ${LF_PAGE_FILES})
endif()
