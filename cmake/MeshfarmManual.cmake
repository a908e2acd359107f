# Manual pages and bash completion, written by the program from the options of its commands.
set(manual_folder ${PROJECT_BINARY_DIR}/manual)
add_custom_command(OUTPUT ${manual_folder}/made
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${manual_folder}
  COMMAND meshfarm --write-manual ${manual_folder}
  COMMAND ${CMAKE_COMMAND} -E touch ${manual_folder}/made
  DEPENDS meshfarm VERBATIM)
add_custom_target(manual ALL DEPENDS ${manual_folder}/made)
install(DIRECTORY ${manual_folder}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(DIRECTORY ${manual_folder}/completions
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion COMPONENT program)
