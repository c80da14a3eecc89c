prowl_test(diagnosis/adjustable_parameter prowl::plan_folder prowl::diagnosis)
prowl_test(diagnosis/diagnosis prowl::plan_folder prowl::diagnosis prowl::screen prowl::solvers prowl::ipopt)
if(PROWL_BUILD_CLI)
  # Five of bench/broken: of each part of a task, those that take seconds.
  add_test(NAME diagnosis/broken COMMAND ${PROWL_PYTHON} ${PROJECT_SOURCE_DIR}/bench/broken/run.py --prowl $<TARGET_FILE:prowl_cli>
    --least 5 --max-time 300 hyq-crouch-stiff-knee hyq-stand-high solo12-crouch-up hyq-stand-start-beyond solo12-stand-two-heights)
  set_tests_properties(diagnosis/broken PROPERTIES COST 30)
  # All forty: what they change is still in the shipped tasks and robots.
  add_test(NAME diagnosis/broken_made COMMAND ${PROWL_PYTHON} ${PROJECT_SOURCE_DIR}/bench/broken/run.py
    --prowl $<TARGET_FILE:prowl_cli> --only-make)
endif()
