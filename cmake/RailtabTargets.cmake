# One place for the compiler options of every railtab target.

# Without AVX-512, GCC copies and clears memory in pieces of 16 bytes, or by `rep stos`. Kernels then read it as vectors of
# 32 bytes, and each such read waits until the stores have left the processor's buffer. With these options, GCC uses the
# widest registers.
include(CheckCXXCompilerFlag)
set(railtab_wide_moves -mmove-max=512 -mstore-max=512
  -mmemcpy-strategy=vector_loop:1024:noalign,libcall:-1:noalign
  -mmemset-strategy=vector_loop:1024:noalign,libcall:-1:noalign)
string(JOIN " " railtab_wide_moves_flags ${railtab_wide_moves})
check_cxx_compiler_flag("${railtab_wide_moves_flags}" RAILTAB_HAS_WIDE_MOVES)

add_library(railtab_options INTERFACE)
target_compile_features(railtab_options INTERFACE cxx_std_20)
target_compile_options(railtab_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<BOOL:${RAILTAB_WARNINGS_AS_ERRORS}>:-Werror>
  # GCC 12 takes its own AVX-512 intrinsics for uninitialised values (GCC bug 105593), and joined strings for copies that
  # overlap (GCC bug 105651).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-uninitialized -Wno-maybe-uninitialized
    -Wno-restrict>
  # How vectors are passed depends on the instruction set: GCC warns of those that are wider than its registers.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>
  $<$<BOOL:${RAILTAB_HAS_WIDE_MOVES}>:${railtab_wide_moves}>
  # Contracted multiply-adds are wanted in the kernels, value-changing shortcuts are not: never -ffast-math.
  $<$<AND:$<BOOL:${RAILTAB_NATIVE}>,$<CONFIG:Release,RelWithDebInfo>>:-march=native>)

# railtab_layer(<name> SOURCES ... [USES <layer>...] [PRIVATE_USES <layer or library>...]): the library railtab_<name> with
# the headers of this folder. A layer sees the headers of the layers that it is linked to and no others: each layer has an
# include folder of its own in the build tree with links to its headers, so that an arrow that points the wrong way does
# not compile. Headers are named from the top of the repository, "railtab/runtime/contact/hertz.hpp", here as where
# they are installed.
function(railtab_layer name)
  cmake_parse_arguments(arg "" "" "SOURCES;USES;PRIVATE_USES" ${ARGN})
  set(target railtab_${name})
  add_library(${target} ${arg_SOURCES})
  add_library(railtab::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE folder)
  set(include ${PROJECT_BINARY_DIR}/include/${name})
  file(REMOVE_RECURSE ${include})
  file(MAKE_DIRECTORY ${include}/railtab/${folder})
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.hpp)
  foreach(header IN LISTS headers)
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${header} ${include}/railtab/${folder}/${header} SYMBOLIC)
  endforeach()
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${include}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM arg_USES PREPEND railtab_ REGEX "^[a-z_]+$")
  list(TRANSFORM arg_PRIVATE_USES PREPEND railtab_ REGEX "^[a-z_]+$")
  target_link_libraries(${target} PUBLIC ${arg_USES} PRIVATE ${arg_PRIVATE_USES}
    $<BUILD_INTERFACE:railtab_options>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # Eigen derives the alignment of its types and the way it frees memory from the instruction set. With -march=native
  # here and not in a consumer of the installed package, one side would free what the other allocated in another way.
  # Stating the alignment makes it part of the interface.
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_ALIGN_BYTES=64 EIGEN_MAX_STATIC_ALIGN_BYTES=32)
endfunction()

# railtab_library_source(<variable> <function> <header>): a source with the files library/*.toml of this folder, as what
# `const std::vector<LibraryFile>& function()` of the header returns; its name in the variable.
function(railtab_library_source variable function header)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/library/*.toml)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/library_files.cpp)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${source} -D FUNCTION=${function} -D HEADER=${header} -D "FILES=${files}"
            -P ${PROJECT_SOURCE_DIR}/cmake/EmbedLibrary.cmake
    DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/EmbedLibrary.cmake
    VERBATIM)
  set(${variable} ${source} PARENT_SCOPE)
endfunction()

# railtab_text_source(<variable> <function> <header> <file>): a source with the text of the file, as what
# `std::string_view function()` of the header returns, in the namespace railtab::report; its name in the variable.
function(railtab_text_source variable function header file)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${source} -D FUNCTION=${function} -D HEADER=${header} -D FILE=${file}
            -P ${PROJECT_SOURCE_DIR}/cmake/EmbedText.cmake
    DEPENDS ${file} ${PROJECT_SOURCE_DIR}/cmake/EmbedText.cmake
    VERBATIM)
  set(${variable} ${source} PARENT_SCOPE)
endfunction()
