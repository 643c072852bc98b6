# The Python module and librailtab-contact are shared libraries of the static ones. What a function's callers inline stays
# the same as without: nobody replaces functions.
if(RAILTAB_PYTHON OR RAILTAB_C)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  add_compile_options($<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-fno-semantic-interposition>)
endif()
