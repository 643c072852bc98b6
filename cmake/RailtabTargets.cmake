# One place for the compiler options of every railtab target.

add_library(railtab_options INTERFACE)
target_compile_features(railtab_options INTERFACE cxx_std_20)
target_compile_options(railtab_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<BOOL:${RAILTAB_WARNINGS_AS_ERRORS}>:-Werror>
  # Contracted multiply-adds are wanted in the kernels, value-changing shortcuts are not: never -ffast-math.
  $<$<AND:$<BOOL:${RAILTAB_NATIVE}>,$<CONFIG:Release,RelWithDebInfo>>:-march=native>)

# railtab_library(<target>): a library whose public headers stand in <folder>/include.
function(railtab_library target)
  add_library(${target})
  add_library(railtab::${target} ALIAS ${target})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:railtab_options>)
  target_compile_features(${target} PUBLIC cxx_std_20)
endfunction()
