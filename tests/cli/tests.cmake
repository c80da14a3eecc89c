if(PROWL_BUILD_CLI)
  foreach(name command doctor new simulate sweep)
    prowl_test(cli/${name} prowl::io nlohmann_json::nlohmann_json)
    target_compile_definitions(cli_${name}_test PRIVATE PROWL_COMMAND="$<TARGET_FILE:prowl_cli>")
    add_dependencies(cli_${name}_test prowl_cli)
  endforeach()

  add_test(NAME cli/figures
    COMMAND ${PROWL_VENV}/bin/python ${CMAKE_CURRENT_LIST_DIR}/figures_test.py $<TARGET_FILE:prowl_cli> ${PROWL_CMEEL}/share)
  set_tests_properties(cli/figures PROPERTIES ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1")
endif()
