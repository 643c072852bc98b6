# The library of an FMU, librailtab-contact and the Python module are shared libraries of the static ones. What a
# function's callers inline stays the same as without: nobody replaces functions.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
add_compile_options($<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-fno-semantic-interposition>)
