# RAILTAB_VERSION: what `--version` prints and files name as the program that wrote them; -D RAILTAB_VERSION=... states
# it, otherwise tools/print_version finds it from git, again after every commit.
if(NOT RAILTAB_VERSION)
  execute_process(COMMAND ${PROJECT_SOURCE_DIR}/tools/print_version
    OUTPUT_VARIABLE RAILTAB_VERSION OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND git rev-parse --path-format=absolute --git-path logs/HEAD
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE commits OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(commits AND EXISTS ${commits})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${commits})
  endif()
endif()
