add_test(NAME scripts/plot_knee COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/plot_knee_test.py)
set_tests_properties(scripts/plot_knee PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
add_test(NAME scripts/mutations COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/mutations_test.py)
set_tests_properties(scripts/mutations PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
