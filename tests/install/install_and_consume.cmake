# Install into a temporary prefix, build each consumer against it, run it.
# Variables: BUILD_DIR (of railtab), CONSUMERS (folder of the projects), NAMES (of the projects), WORK_DIR (emptied),
# CXX_COMPILER, CXX_FLAGS, VERSION

cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message(STATUS "${ARGN}\n${output}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "exit status ${status} of ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)

foreach(consumer IN LISTS NAMES)
  run(${CMAKE_COMMAND} -S ${CONSUMERS}/${consumer} -B ${WORK_DIR}/${consumer} -G Ninja
    -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D CMAKE_CXX_COMPILER=${CXX_COMPILER} "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
    -D RAILTAB_VERSION=${VERSION})
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/${consumer})
  run(${WORK_DIR}/${consumer}/consumer)
  file(SIZE ${WORK_DIR}/${consumer}/consumer bytes)
  message(STATUS "size of the program that uses railtab::${consumer}: ${bytes} bytes")
endforeach()

# The contact library alone brings neither the reader of files nor any part of the solver.
function(require_no_symbol consumer pattern)
  execute_process(COMMAND nm --demangle ${WORK_DIR}/${consumer}/consumer OUTPUT_VARIABLE symbols)
  string(REGEX MATCH "[^\n]*(${pattern})[^\n]*" found "${symbols}")
  if(found)
    message(FATAL_ERROR "railtab::${consumer} brings ${found}")
  endif()
endfunction()
require_no_symbol(contact "H5[A-Z]|toml::|StructureModel|VehicleModel|VsiModel|SceneParameters")
require_no_symbol(contact_files "toml::|StructureModel|VehicleModel|VsiModel|SceneParameters")
if("contact_c" IN_LIST NAMES)
  require_no_symbol(contact_c "railtab::|std::|H5[A-Z]")
endif()

# Another minor version and an unknown component are rejected.
foreach(wrong -DRAILTAB_VERSION=0.0.9 "-DRAILTAB_VERSION=${VERSION};-DRAILTAB_COMPONENTS=wheels")
  file(REMOVE_RECURSE ${WORK_DIR}/wrong)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${CONSUMERS}/contact -B ${WORK_DIR}/wrong -G Ninja
    -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D CMAKE_CXX_COMPILER=${CXX_COMPILER} ${wrong}
    RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if(status EQUAL 0)
    message(FATAL_ERROR "find_package accepted ${wrong}")
  endif()
endforeach()
