if(PROWL_BUILD_CLI)
  prowl_test(tasks/shipped_tasks prowl::io nlohmann_json::nlohmann_json)
  target_compile_definitions(tasks_shipped_tasks_test PRIVATE PROWL_COMMAND="$<TARGET_FILE:prowl_cli>")
  add_dependencies(tasks_shipped_tasks_test prowl_cli)
  # HyQ's take half of the time: with the others beside them the cores are in balance.
  set_tests_properties(tasks/shipped_tasks PROPERTIES ENVIRONMENT "GTEST_FILTER=-*hyq*")
  add_test(NAME tasks/shipped_tasks_of_hyq COMMAND tasks_shipped_tasks_test --gtest_filter=*hyq*)
endif()
