# Files and names of commit 0f26b62: README.md.
if(PROWL_BUILD_CLI AND PROWL_BUILD_PYTHON)
  add_test(NAME compatibility
    COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/compatibility_test.py $<TARGET_FILE:prowl_cli>)
  set_tests_properties(compatibility PROPERTIES TIMEOUT 900 ENVIRONMENT
    "PYTHONPATH=${PROJECT_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1")
endif()
