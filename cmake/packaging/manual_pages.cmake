# Run by cpack before it packs: help2man makes a manual page of photile and one of each command, from
# what --help prints.
find_program(HELP2MAN help2man)
if(NOT HELP2MAN)
  message(FATAL_ERROR "The package photile holds manual pages, which need help2man: apt-get install help2man")
endif()
set(_command ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/command/usr)
set(_pages ${_command}/share/man/man1)
set(_tool ${_command}/bin/photile)
file(MAKE_DIRECTORY ${_pages})

# "render      Render a scene ...", in its list of commands
execute_process(COMMAND ${_tool} --help OUTPUT_VARIABLE _help COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE ".*\nSubcommands:\n" "" _list "${_help}")
string(REPLACE ";" "\\;" _list "${_list}")
string(REGEX MATCHALL "  [a-z]+ [^\n]*" _entries "${_list}")

function(write_page name description)
  # A page bears the name of the program, so each command gets a program of its name.
  set(program ${CPACK_TOPLEVEL_DIRECTORY}/manual-pages/${name})
  file(WRITE ${program} "#!/bin/sh\nexec '${_tool}' ${ARGN} \"$@\"\n")
  file(CHMOD ${program} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
  execute_process(COMMAND ${HELP2MAN} --no-info "--name=${description}"
    "--version-string=${CPACK_PACKAGE_VERSION}" --output=${_pages}/${name}.1 ${program}
    COMMAND_ERROR_IS_FATAL ANY)
endfunction()
write_page(photile "photon mapping on OpenCL devices, a layer of the picture per light")
foreach(_entry IN LISTS _entries)
  string(REGEX MATCH "([a-z]+) +(.*)" _ "${_entry}")
  write_page(photile-${CMAKE_MATCH_1} "${CMAKE_MATCH_2}" ${CMAKE_MATCH_1})
endforeach()
