if(PROWL_BUILD_PYTHON AND PROWL_BUILD_CLI)
  set(pytest ${PROWL_PYTHON} -m pytest -q -p no:cacheprovider --durations=5)
  add_test(NAME python/package COMMAND ${pytest} ${PROJECT_SOURCE_DIR}/python/tests)
  set_tests_properties(python/package PROPERTIES ENVIRONMENT
    "PYTHONPATH=${PROJECT_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1;PROWL_COMMAND=$<TARGET_FILE:prowl_cli>")

  # Beside the build folder and as deep: objects are the same for ccache.
  add_test(NAME python/wheel COMMAND ${pytest} ${CMAKE_CURRENT_LIST_DIR}/wheel_test.py)
  set_tests_properties(python/wheel PROPERTIES TIMEOUT 3600 ENVIRONMENT
    "PYTHONDONTWRITEBYTECODE=1;CXX=${CMAKE_CXX_COMPILER};PROWL_WHEEL_BUILD=${PROJECT_BINARY_DIR}-wheel")
endif()
