# Run while installing: writes manual pages and completions as PHOTILE_COMMAND prints them.
function(print_into file)
  execute_process(COMMAND ${PHOTILE_COMMAND} ${ARGN} OUTPUT_FILE ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${PHOTILE_SCRATCH})
file(MAKE_DIRECTORY ${PHOTILE_SCRATCH}/man1)
print_into(${PHOTILE_SCRATCH}/man1/photile.1 --manual photile)
# Its list of commands.
file(READ ${PHOTILE_SCRATCH}/man1/photile.1 _page)
string(REGEX MATCHALL "\n\\.TP\n\\\\fB[a-z]+\\\\fR\n" _entries "${_page}")
foreach(_entry IN LISTS _entries)
  string(REGEX REPLACE ".*fB([a-z]+).*" "\\1" _subcommand "${_entry}")
  print_into(${PHOTILE_SCRATCH}/man1/photile-${_subcommand}.1 --manual ${_subcommand})
endforeach()
foreach(_shell IN ITEMS bash zsh fish)
  print_into(${PHOTILE_SCRATCH}/${_shell} --completion ${_shell})
endforeach()

set(_share ${CMAKE_INSTALL_PREFIX}/share)
file(INSTALL ${PHOTILE_SCRATCH}/man1 DESTINATION ${_share}/man)
file(INSTALL ${PHOTILE_SCRATCH}/bash DESTINATION ${_share}/bash-completion/completions RENAME photile)
file(INSTALL ${PHOTILE_SCRATCH}/zsh DESTINATION ${_share}/zsh/vendor-completions RENAME _photile)
file(INSTALL ${PHOTILE_SCRATCH}/fish DESTINATION ${_share}/fish/vendor_completions.d
  RENAME photile.fish)
