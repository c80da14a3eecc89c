if(PROWL_BUILD_CLI)
  prowl_test(cli/command prowl::io nlohmann_json::nlohmann_json)
  target_compile_definitions(cli_command_test PRIVATE PROWL_COMMAND="$<TARGET_FILE:prowl_cli>")
  add_dependencies(cli_command_test prowl_cli)

  add_test(NAME cli/figures
    COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/figures_test.py $<TARGET_FILE:prowl_cli> ${PROWL_CMEEL}/share)
  set_tests_properties(cli/figures PROPERTIES ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1")
endif()
