if(PROWL_BUILD_CLI AND PROWL_BUILD_PYTHON)
  add_library(example_own_terms MODULE ${PROJECT_SOURCE_DIR}/examples/own_terms.cpp)
  target_link_libraries(example_own_terms PRIVATE prowl::prowl)
  add_test(NAME examples COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/examples/examples_test.py
    $<TARGET_FILE:prowl_cli> ${PROWL_CMEEL}/share $<TARGET_FILE:example_own_terms> ${PROJECT_BINARY_DIR}/python)
endif()
