# Installs the program with its manual and launchers, the layers as libraries, and a package config, so that
#   find_package(meshfarm) + target_link_libraries(app meshfarm::geometry meshfarm::io)
# gives the simplifier and the mesh files without the farm.
include(CMakePackageConfigHelpers)
set(layers util geometry staging io)
list(TRANSFORM layers PREPEND meshfarm_ OUTPUT_VARIABLE layer_targets)
install(TARGETS meshfarm RUNTIME COMPONENT program)
install(TARGETS meshfarm_web LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/meshfarm COMPONENT program)
install(PROGRAMS scripts/launch-common.sh scripts/launch-local.sh scripts/launch-ssh.sh
                 scripts/launch-slurm.sh
        DESTINATION ${CMAKE_INSTALL_DATADIR}/meshfarm COMPONENT program)
install(DIRECTORY conf/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(TARGETS ${layer_targets} EXPORT meshfarmTargets ARCHIVE COMPONENT library)
foreach(layer ${layers})
  install(DIRECTORY include/meshfarm/${layer} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/meshfarm
          COMPONENT library)
endforeach()
install(EXPORT meshfarmTargets NAMESPACE meshfarm:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/meshfarm
        COMPONENT library)
configure_package_config_file(cmake/meshfarmConfig.cmake.in ${PROJECT_BINARY_DIR}/meshfarmConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/meshfarm)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/meshfarmConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/meshfarmConfig.cmake
              ${PROJECT_BINARY_DIR}/meshfarmConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/meshfarm COMPONENT library)
