if(PROWL_BUILD_CLI)
  add_test(NAME second_checker COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/second_checker/second_checker_test.py
    $<TARGET_FILE:prowl_cli> ${PROWL_CMEEL}/share)
endif()
