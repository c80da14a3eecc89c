if(BUILD_SHARED_LIBS AND PROWL_BUILD_CLI)
  string(REPLACE ";" "\\;" internal_headers "${PROWL_INTERNAL_HEADERS}")
  add_test(NAME install/consumer COMMAND ${CMAKE_COMMAND}
    -DBUILD_DIR=${PROJECT_BINARY_DIR} -DNINJA=${CMAKE_MAKE_PROGRAM} -DCONSUMER_DIR=${CMAKE_CURRENT_LIST_DIR}/consumer -DEXAMPLES_DIR=${PROJECT_SOURCE_DIR}/examples
    -DROBOTS_DATA=${PROWL_CMEEL}/share -DINTERNAL_HEADERS=${internal_headers}
    -DWORK_DIR=${PROJECT_BINARY_DIR}/tests/install -P ${CMAKE_CURRENT_LIST_DIR}/install_test.cmake)
endif()
if(PROWL_BUILD_PYTHON AND PROWL_BUILD_CLI)
  add_test(NAME install/wheel COMMAND ${PROWL_PYTHON} -m pytest -q -p no:cacheprovider --durations=8 -rP
    ${CMAKE_CURRENT_LIST_DIR}/wheel_test.py)
  set_tests_properties(install/wheel PROPERTIES TIMEOUT 3600 ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;CXX=${CMAKE_CXX_COMPILER}")
endif()
