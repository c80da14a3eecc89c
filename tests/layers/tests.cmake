add_test(NAME layers/includes
  COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/check_includes.py ${PROJECT_SOURCE_DIR}
    ${PROWL_INTERNAL_HEADERS})
add_test(NAME layers/check_includes COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/check_includes_test.py)
add_test(NAME layers/friends COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/friends_test.py)
set_tests_properties(layers/includes layers/check_includes layers/friends PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)

# The list of functions in docs/architecture.md, against a trace of GCC's shared libraries by glibc's linker.
if(BUILD_SHARED_LIBS AND PROWL_BUILD_CLI AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
  add_test(NAME layers/flow COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/flow_test.py $<TARGET_FILE:prowl_cli>)
  set_tests_properties(layers/flow PROPERTIES TIMEOUT 600 ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
endif()
