# Manual pages and bash completion, which the programs generate from their --help.
set(manual "${CMAKE_BINARY_DIR}/manual")
add_custom_command(OUTPUT "${manual}/completions/evical"
  COMMAND "${CMAKE_COMMAND}" -E rm -rf "${manual}/man1" "${manual}/completions"
  COMMAND evical manual -o "${manual}"
  DEPENDS evical COMMENT "Manual pages and completion of evical" VERBATIM)
set(manual_files "${manual}/completions/evical")
if(EVICAL_GUI)
  # A separate folder, since man1 is removed and regenerated, without pages of commands that no longer exist.
  file(MAKE_DIRECTORY "${manual}/desktop/man1")
  add_custom_command(OUTPUT "${manual}/desktop/man1/evical-gui.1"
    COMMAND "${CMAKE_COMMAND}" -E env QT_QPA_PLATFORM=offscreen "$<TARGET_FILE:evical-gui>" --manual
            > "${manual}/desktop/man1/evical-gui.1"
    DEPENDS evical-gui COMMENT "Manual page of evical-gui" VERBATIM)
  list(APPEND manual_files "${manual}/desktop/man1/evical-gui.1")
endif()
add_custom_target(manual ALL DEPENDS ${manual_files})

install(DIRECTORY "${manual}/man1" DESTINATION "${CMAKE_INSTALL_MANDIR}" COMPONENT command_line)
install(FILES "${manual}/completions/evical" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions"
        COMPONENT command_line)
install(DIRECTORY config/scenarios DESTINATION "${CMAKE_INSTALL_DATADIR}/evical" COMPONENT command_line)
install(FILES config/default.yaml DESTINATION "${CMAKE_INSTALL_DATADIR}/evical" COMPONENT command_line)
if(EVICAL_GUI)
  install(FILES "${manual}/desktop/man1/evical-gui.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT desktop)
  install(FILES resources/desktop/evical.desktop DESTINATION "${CMAKE_INSTALL_DATADIR}/applications" COMPONENT desktop)
  install(FILES resources/desktop/evical.xml DESTINATION "${CMAKE_INSTALL_DATADIR}/mime/packages" COMPONENT desktop)
  install(FILES resources/desktop/evical.svg DESTINATION "${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps"
          COMPONENT desktop)
  install(FILES resources/desktop/org.evical.evical.metainfo.xml DESTINATION "${CMAKE_INSTALL_DATADIR}/metainfo"
          COMPONENT desktop)
endif()
