# Run by `cmake --install`: copies the public headers of `source`/lf to `destination`/lf, without test headers and
# headers that say "Internal to" their folder.
file(GLOB_RECURSE headers RELATIVE ${source} ${source}/lf/*.h)
foreach(header ${headers})
  file(READ ${source}/${header} top LIMIT 1000)
  get_filename_component(name ${header} NAME)
  if(top MATCHES "Internal[ /\n]+to[ /\n]+(this[ /\n]+folder|[a-z]+)\\." OR name MATCHES "^test(ing)?_")
    continue()
  endif()
  get_filename_component(folder ${header} DIRECTORY)
  file(INSTALL ${source}/${header} DESTINATION ${CMAKE_INSTALL_PREFIX}/${destination}/${folder})
endforeach()
