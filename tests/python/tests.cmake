if(PROWL_BUILD_PYTHON AND PROWL_BUILD_CLI)
  set(pytest ${PROWL_PYTHON} -m pytest -q -p no:cacheprovider --durations=5)
  add_test(NAME python/package COMMAND ${pytest} ${PROJECT_SOURCE_DIR}/python/tests)
  set_tests_properties(python/package PROPERTIES ENVIRONMENT
    "PYTHONPATH=${PROJECT_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1;PROWL_COMMAND=$<TARGET_FILE:prowl_cli>")
endif()
