# Install rules and the CMake package. find_package(railtab) gives, each with what it needs below it,
#   railtab::contact        profiles, tables in memory, look-up, wheel force: for other multibody programs
#   railtab::contact_files  the reader of table files (HDF5)
#   railtab::solver         vehicles, structures, scenes, runs
#   railtab::tablegen       the offline side, where it was built; alone needs CGAL, FFTW and OpenMP

include(CMakePackageConfigHelpers)

set(railtab_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/railtab)

get_property(railtab_layers GLOBAL PROPERTY railtab_layers)
set(railtab_core ${railtab_layers})
list(REMOVE_ITEM railtab_core railtab_tablegen railtab_report)
install(TARGETS ${railtab_core} railtab_solver EXPORT railtabCore)
install(EXPORT railtabCore NAMESPACE railtab:: DESTINATION ${railtab_package_dir})
foreach(layer IN LISTS railtab_core)
  railtab_install_headers(${layer})
endforeach()

if(TARGET railtab_tablegen)
  install(TARGETS railtab_tablegen EXPORT railtabTablegen)
  railtab_install_headers(railtab_tablegen)
  install(EXPORT railtabTablegen NAMESPACE railtab:: DESTINATION ${railtab_package_dir})
endif()

install(FILES ${PROJECT_SOURCE_DIR}/tables/data/creep_table_nu028.h5 DESTINATION ${CMAKE_INSTALL_DATADIR}/railtab)

# Both commands in one folder of the build: build/<preset>/bin
foreach(command tablegen_command vsi_command)
  if(TARGET ${command})
    set_target_properties(${command} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
    install(TARGETS ${command})
  endif()
endforeach()

# What the static tablegen library needs at a consumer's link.
set(railtab_tablegen_dependencies "find_dependency(OpenMP COMPONENTS CXX)")
if(TARGET railtab_tablegen)
  get_target_property(railtab_tablegen_links railtab_tablegen LINK_LIBRARIES)
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
