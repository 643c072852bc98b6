# Install rules and the CMake package: find_package(railtab) gives railtab::tables, railtab::runtime and, where it was
# built, railtab::tablegen. The core and the offline side are exported apart, so that a user of the core alone needs
# neither CGAL nor OpenMP.

include(CMakePackageConfigHelpers)

set(railtab_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/railtab)

install(TARGETS tables runtime EXPORT railtabCore)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tables/include/ ${PROJECT_SOURCE_DIR}/runtime/include/
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT railtabCore NAMESPACE railtab:: DESTINATION ${railtab_package_dir})

if(TARGET tablegen)
  install(TARGETS tablegen EXPORT railtabTablegen)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/tablegen/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT railtabTablegen NAMESPACE railtab:: DESTINATION ${railtab_package_dir})
endif()

install(FILES ${PROJECT_SOURCE_DIR}/tables/data/creep_table_nu028.h5 DESTINATION ${CMAKE_INSTALL_DATADIR}/railtab)

# Both commands in one folder of the build: build/<preset>/bin
foreach(command tablegen_command vsi)
  if(TARGET ${command})
    set_target_properties(${command} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
    install(TARGETS ${command})
  endif()
endforeach()

# What the static tablegen library needs at a consumer's link.
set(railtab_tablegen_dependencies "find_dependency(OpenMP COMPONENTS CXX)")
if(TARGET tablegen)
  get_target_property(railtab_tablegen_links tablegen LINK_LIBRARIES)
  if("${railtab_tablegen_links}" MATCHES "CGAL::CGAL")
    string(APPEND railtab_tablegen_dependencies "\n  find_dependency(CGAL)")
  endif()
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/railtabConfig.cmake.in
  ${PROJECT_BINARY_DIR}/railtabConfig.cmake INSTALL_DESTINATION ${railtab_package_dir})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/railtabConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/railtabConfig.cmake ${PROJECT_BINARY_DIR}/railtabConfigVersion.cmake
  DESTINATION ${railtab_package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})
