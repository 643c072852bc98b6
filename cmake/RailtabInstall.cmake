# Install rules and the CMake package. What is installed is a named list of headers for three audiences; all else may
# change.
#   railtab::contact        profiles, tables in memory, look-up, wheel force: for other multibody programs
#   railtab::contact_files  the same with the reader of table files (HDF5)
#   railtab::contact_c      the shared library of railtab/contact.h, for C and Fortran
#   railtab::solver         scenes and their runs

include(CMakePackageConfigHelpers)

set(railtab_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/railtab)

set(railtab_contact_headers
  runtime/base/input_error.hpp
  runtime/base/lane_numbers.hpp
  tables/creep_table.hpp
  tables/geometry_leaf.hpp
  tables/geometry_table.hpp
  tables/loaded_table.hpp
  tables/profile_knots.hpp
  tables/provenance.hpp
  runtime/profile/profile_curve.hpp
  runtime/profile/profile_file.hpp
  runtime/profile/standard_profiles.hpp
  runtime/profile/wheel_rail_pair.hpp
  runtime/contact/contact_geometry.hpp
  runtime/contact/contact_pair.hpp
  runtime/contact/contact_patch.hpp
  runtime/contact/contact_search.hpp
  runtime/contact/contact_search_scan.hpp
  runtime/contact/creep_law.hpp
  runtime/contact/friction_law.hpp
  runtime/contact/hertz.hpp
  runtime/contact/paper_search.hpp
  runtime/contact/patch_loads.hpp
  runtime/contact/table_contact.hpp
  runtime/contact/wheel_contact.hpp
  runtime/contact/wheel_silhouette.hpp)
set(railtab_contact_files_headers
  tables/files/creep_table_file.hpp
  tables/files/geometry_table_file.hpp
  runtime/contact_files/creep_law_file.hpp)
set(railtab_solver_headers
  runtime/vsi/step_record.hpp
  runtime/scene/scene.hpp)

set(railtab_contact_layers base tables profile contact)
set(railtab_contact_files_layers table_files contact_files)
set(railtab_solver_layers algebra fe measures reliability vehicle assessment structure moving_load line vsi start stability drawing results scene solver)
foreach(component contact contact_files solver)
  list(TRANSFORM railtab_${component}_layers PREPEND railtab_ OUTPUT_VARIABLE layers)
  install(TARGETS ${layers} EXPORT railtab_${component})
  install(EXPORT railtab_${component} NAMESPACE railtab:: DESTINATION ${railtab_package_dir})
  foreach(header IN LISTS railtab_${component}_headers)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/railtab/${folder})
  endforeach()
endforeach()

if(TARGET railtab_contact_c)
  install(TARGETS railtab_contact_c EXPORT railtab_contact_c)
  install(EXPORT railtab_contact_c NAMESPACE railtab:: DESTINATION ${railtab_package_dir})
  install(FILES ${PROJECT_SOURCE_DIR}/c/railtab/contact.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/railtab)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/examples/contact
    DESTINATION ${CMAKE_INSTALL_DATADIR}/railtab/examples)
endif()

install(FILES ${PROJECT_SOURCE_DIR}/tables/data/creep_table_nu028.h5 DESTINATION ${CMAKE_INSTALL_DATADIR}/railtab)
# also compiled in; these are for users to read and to start their own from
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/vehicle/library/ DESTINATION ${CMAKE_INSTALL_DATADIR}/railtab/vehicles)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/moving_load/library/ DESTINATION ${CMAKE_INSTALL_DATADIR}/railtab/trains)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/assessment/library/ DESTINATION ${CMAKE_INSTALL_DATADIR}/railtab/clauses)

# Both commands in one folder of the build: build/<preset>/bin
foreach(command tablegen_command vsi_command)
  if(TARGET ${command})
    set_target_properties(${command} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
    install(TARGETS ${command})
  endif()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/railtabConfig.cmake.in
  ${PROJECT_BINARY_DIR}/railtabConfig.cmake INSTALL_DESTINATION ${railtab_package_dir})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/railtabConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/railtabConfig.cmake ${PROJECT_BINARY_DIR}/railtabConfigVersion.cmake
  DESTINATION ${railtab_package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})
