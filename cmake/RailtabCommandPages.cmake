# Man pages and completions of the commands, made from what `vsi --json-usage` prints.
find_package(Python3 QUIET COMPONENTS Interpreter)

# railtab_command_pages(<target> <program>)
function(railtab_command_pages target program)
  set(pages ${PROJECT_BINARY_DIR}/command_pages/${program})
  add_custom_command(OUTPUT ${pages}.json
    COMMAND ${target} --json-usage > ${pages}.json
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/command_pages ${pages} < ${pages}.json
    DEPENDS ${target} ${PROJECT_SOURCE_DIR}/tools/command_pages
    COMMENT "Man pages and completions of ${program}"
    VERBATIM)
  add_custom_target(${target}_pages ALL DEPENDS ${pages}.json)
  install(DIRECTORY ${pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
  install(DIRECTORY ${pages}/bash/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(DIRECTORY ${pages}/zsh/ DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
endfunction()

file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/command_pages)
if(Python3_Interpreter_FOUND)
  railtab_command_pages(vsi_command vsi)
  if(TARGET tablegen_command)
    railtab_command_pages(tablegen_command tablegen)
  endif()
endif()
