# Installs BUILD_DIR, then configures, builds and runs the consumer against the installed tree alone. Run by ctest:
#   cmake -DBUILD_DIR=... -DCONSUMER_DIR=... -DROBOTS_DATA=... -DWORK_DIR=... -P install_test.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message(STATUS "${output}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "status ${status} from ${ARGN}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
set(prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
foreach(header ${INTERNAL_HEADERS})
  if(EXISTS ${prefix}/include/${header})
    message(FATAL_ERROR "${header} is internal, but installed")
  endif()
endforeach()

run(${prefix}/bin/prowl --version)
run(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
  -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/consumer ${prefix}/share/prowl/tasks/hyq/hold.toml ${ROBOTS_DATA})
if(NOT output MATCHES "converged, cost [0-9]")
  message(FATAL_ERROR "the consumer did not plan: ${output}")
endif()
