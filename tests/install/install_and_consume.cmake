# Install into a temporary prefix, build the consumer against it, run it.
# Variables: BUILD_DIR (of railtab), CONSUMER_DIR, WORK_DIR (emptied), CXX_COMPILER, CXX_FLAGS, VERSION

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

set(configure ${CMAKE_COMMAND} -S ${CONSUMER_DIR} -G Ninja
  -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D "CMAKE_CXX_FLAGS=${CXX_FLAGS}")

# With everything that was installed, and with the core alone.
run(${configure} -B ${WORK_DIR}/all -D RAILTAB_VERSION=${VERSION})
run(${configure} -B ${WORK_DIR}/core -D RAILTAB_VERSION=${VERSION} -D RAILTAB_COMPONENTS=solver)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/core)
run(${WORK_DIR}/core/consumer)

# Another minor version and an unknown component are refused.
foreach(wrong -DRAILTAB_VERSION=0.0.9 "-DRAILTAB_VERSION=${VERSION};-DRAILTAB_COMPONENTS=wheels")
  execute_process(COMMAND ${configure} -B ${WORK_DIR}/wrong ${wrong} RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if(status EQUAL 0)
    message(FATAL_ERROR "find_package accepted ${wrong}")
  endif()
endforeach()
