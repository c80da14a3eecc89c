if(PROWL_BUILD_CLI)
  foreach(name checkpoint command compare completion doctor faults help json new progress screen simulate sweep)
    prowl_test(cli/${name} prowl::plan_folder nlohmann_json::nlohmann_json)
    target_compile_definitions(cli_${name}_test PRIVATE PROWL_COMMAND="$<TARGET_FILE:prowl_cli>")
    target_compile_definitions(cli_${name}_test PRIVATE PROWL_HAS_PYTHON=$<BOOL:${PROWL_BUILD_PYTHON}>)
    add_dependencies(cli_${name}_test prowl_cli)
    if(PROWL_BUILD_PYTHON)  # which does some of the verbs
      add_dependencies(cli_${name}_test prowl_python)
    endif()
  endforeach()

  target_compile_definitions(cli_compare_test PRIVATE PROWL_SNOPT_DOUBLE="$<TARGET_FILE:snopt_double>")
  add_dependencies(cli_compare_test snopt_double)

  # For LD_PRELOAD: an older Ipopt, files that cannot be written.
  add_library(old_ipopt SHARED ${CMAKE_CURRENT_LIST_DIR}/old_ipopt.cpp)
  target_compile_definitions(cli_doctor_test PRIVATE PROWL_OLD_IPOPT="$<TARGET_FILE:old_ipopt>")
  add_dependencies(cli_doctor_test old_ipopt)
  add_library(faulty_files SHARED ${CMAKE_CURRENT_LIST_DIR}/faulty_files.cpp)
  target_link_libraries(faulty_files PRIVATE ${CMAKE_DL_LIBS})
  target_compile_definitions(cli_faults_test PRIVATE PROWL_FAULTY_FILES="$<TARGET_FILE:faulty_files>")
  add_dependencies(cli_faults_test faulty_files)
  set_tests_properties(cli/faults PROPERTIES TIMEOUT 3600)  # PROWL_KILLS=200

  find_package(CLI11 REQUIRED)
  # A command of verbs of verbs, for the completion of what prowl itself need not have.
  add_executable(cli_completion_tree ${CMAKE_CURRENT_LIST_DIR}/completion_tree.cpp ${PROJECT_SOURCE_DIR}/cli/verbs/completion_command.cpp
    ${PROJECT_SOURCE_DIR}/cli/process/interrupt.cpp ${PROJECT_SOURCE_DIR}/cli/screen/output.cpp
    ${PROJECT_SOURCE_DIR}/cli/screen/paint.cpp ${PROJECT_SOURCE_DIR}/cli/screen/terminal.cpp
    ${PROJECT_SOURCE_DIR}/cli/process/program_files.cpp ${PROJECT_SOURCE_DIR}/cli/options/shared_options.cpp)
  target_link_libraries(cli_completion_tree PRIVATE prowl::plan_folder CLI11::CLI11 fmt::fmt)
  target_compile_definitions(cli_completion_test PRIVATE PROWL_COMPLETION_TREE="$<TARGET_FILE:cli_completion_tree>")
  add_dependencies(cli_completion_test cli_completion_tree)

  # Malicious files: docs/reliability.md.
  add_test(NAME cli/bad_input
    COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/bad_input_test.py $<TARGET_FILE:prowl_cli>)
  set_tests_properties(cli/bad_input PROPERTIES TIMEOUT 1200 ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1")

  # Runs of online control: seeds that nothing was tuned with.
  foreach(robot hyq go2)
    add_test(NAME cli/online_seeds_${robot}
      COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/online_seeds_test.py $<TARGET_FILE:prowl_cli> ${robot})
    set_tests_properties(cli/online_seeds_${robot} PROPERTIES TIMEOUT 1800 ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
  endforeach()

  # What prowl writes, read by somebody else's code; and a terminal for it that closes.
  set(python_tests determinism plan_schema hang_up online terminal)
  if(PROWL_BUILD_PYTHON)
    list(APPEND python_tests figures exports export_command)
  endif()
  foreach(name ${python_tests})
    add_test(NAME cli/${name}
      COMMAND ${PROWL_VENV}/bin/python ${CMAKE_CURRENT_LIST_DIR}/${name}_test.py $<TARGET_FILE:prowl_cli> ${PROWL_CMEEL}/share)
    set_tests_properties(cli/${name} PROPERTIES ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1")
  endforeach()
endif()
