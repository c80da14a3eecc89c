add_test(NAME layers/includes
  COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/check_includes.py ${PROJECT_SOURCE_DIR}
    ${PROWL_INTERNAL_HEADERS})
add_test(NAME layers/check_includes COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/check_includes_test.py)
set_tests_properties(layers/includes layers/check_includes PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
