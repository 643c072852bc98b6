# A whole build in a fraction of the time: headers that nearly every source includes are parsed once, and several sources
# of a library or command are compiled as one. Sources still include all that they use, and do not see each other's:
# `tools/check includes` is the check. While a file is edited, a build without RAILTAB_FAST_BUILD compiles that file
# alone.

set(railtab_precompiled_headers
  <Eigen/Dense> <Eigen/SparseCholesky> <Eigen/SparseCore> <fmt/format.h>
  <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <limits> <map> <memory> <numbers> <optional> <random>
  <span> <string> <string_view> <vector>)

# railtab_precompiled_set(<name> <header>... LIBRARIES ...): a set of precompiled headers for other targets to reuse.
function(railtab_precompiled_set name)
  cmake_parse_arguments(arg "" "" "HEADERS;LIBRARIES" ${ARGN})
  set(source ${PROJECT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// carries precompiled headers\n")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE railtab_options Eigen3::Eigen fmt::fmt ${arg_LIBRARIES})
  target_compile_definitions(${name} PRIVATE $<TARGET_PROPERTY:railtab_base,INTERFACE_COMPILE_DEFINITIONS>)
  target_precompile_headers(${name} PRIVATE ${railtab_precompiled_headers} ${arg_HEADERS})
endfunction()

# All targets made so far in `folder` and below.
function(railtab_targets_below folder result)
  get_property(found DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(next IN LISTS below)
    railtab_targets_below(${next} more)
    list(APPEND found ${more})
  endforeach()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

set(railtab_sources_together 16)  # per compilation
# Tests spend their time in the libraries: their own code is compiled in three quarters of the time of -O2.
set(railtab_test_options $<$<CONFIG:RelWithDebInfo>:-O1>)
find_program(RAILTAB_GOLD ld.gold)  # links in half the time; of binutils
mark_as_advanced(RAILTAB_GOLD)
set(railtab_test_linker $<$<AND:$<BOOL:${RAILTAB_GOLD}>,$<CONFIG:RelWithDebInfo>>:-fuse-ld=gold>)

# Every target of the project that compiles sources. Those with OpenMP's options cannot share what was compiled without.
# Sources of tests stay apart: each program has few.
function(railtab_fast_build)
  railtab_precompiled_set(railtab_precompiled)
  if(RAILTAB_TABLEGEN)
    find_package(OpenMP REQUIRED COMPONENTS CXX)
    railtab_precompiled_set(railtab_precompiled_openmp LIBRARIES OpenMP::OpenMP_CXX)
  endif()
  if(RAILTAB_TESTS)
    find_package(GTest REQUIRED)
    railtab_precompiled_set(railtab_precompiled_tests HEADERS <gtest/gtest.h> LIBRARIES GTest::gtest)
    target_compile_options(railtab_precompiled_tests PRIVATE ${railtab_test_options})
  endif()
  railtab_targets_below(${PROJECT_SOURCE_DIR} targets)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(links ${target} LINK_LIBRARIES)
    if(target MATCHES "^railtab_precompiled" OR NOT type MATCHES "EXECUTABLE|STATIC_LIBRARY|SHARED_LIBRARY")
      continue()
    endif()
    if(CMAKE_POSITION_INDEPENDENT_CODE AND type STREQUAL "EXECUTABLE")
      # reuse headers that were precompiled for libraries, whose code is position-independent in another way
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${target} PRIVATE -fPIC)
    endif()
    if(NOT "${links}" MATCHES "GTest::|benchmark::")
      set_target_properties(${target} PROPERTIES
        UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${railtab_sources_together})
      # Generated sources stay apart, so that clang-tidy can read the others before anything is built.
      get_target_property(sources ${target} SOURCES)
      list(FILTER sources INCLUDE REGEX "^${PROJECT_BINARY_DIR}/")
      set_source_files_properties(${sources} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      # GCC 12 takes arrays for too small in functions that it inlines.
      target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow)
    endif()
    if(NOT "${links}" MATCHES "railtab_[a-z]+" OR target STREQUAL railtab_report)
      continue()  # knows nothing of Eigen
    elseif("${links}" MATCHES "GTest::")
      target_compile_options(${target} PRIVATE ${railtab_test_options})
      target_link_options(${target} PRIVATE ${railtab_test_linker})
      target_precompile_headers(${target} REUSE_FROM railtab_precompiled_tests)
    elseif("${links}" MATCHES "OpenMP::")
      target_precompile_headers(${target} REUSE_FROM railtab_precompiled_openmp)
    else()
      target_precompile_headers(${target} REUSE_FROM railtab_precompiled)
    endif()
  endforeach()
endfunction()
