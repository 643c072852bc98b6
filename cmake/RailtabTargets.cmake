# One place for the compiler options of every railtab target.

add_library(railtab_options INTERFACE)
target_compile_features(railtab_options INTERFACE cxx_std_20)
target_compile_options(railtab_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<BOOL:${RAILTAB_WARNINGS_AS_ERRORS}>:-Werror>
  # GCC 12 takes its own AVX-512 intrinsics for uninitialised values (GCC bug 105593).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-uninitialized -Wno-maybe-uninitialized>
  # Contracted multiply-adds are wanted in the kernels, value-changing shortcuts are not: never -ffast-math.
  $<$<AND:$<BOOL:${RAILTAB_NATIVE}>,$<CONFIG:Release,RelWithDebInfo>>:-march=native>)

# railtab_library(<target>): a library whose public headers stand in <folder>/include.
function(railtab_library target)
  add_library(${target})
  add_library(railtab::${target} ALIAS ${target})
  # librailtab_tables.a, not a bare libtables.a in the system's library folder
  set_target_properties(${target} PROPERTIES OUTPUT_NAME railtab_${target})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:railtab_options>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # Eigen derives the alignment of its types and the way it frees memory from the instruction set. With -march=native
  # here and not in a consumer of the installed package, one side would free what the other allocated in another way.
  # Stating the alignment makes it part of the interface.
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_ALIGN_BYTES=64 EIGEN_MAX_STATIC_ALIGN_BYTES=32)
endfunction()
