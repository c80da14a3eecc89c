prowl_test(tracking/riccati_flow prowl::tracking)
prowl_test(tracking/linearised_dynamics prowl::tracking null_space_dynamics)
prowl_test(tracking/feedback_design prowl::prowl)
prowl_test(tracking/rollout prowl::prowl)
prowl_test(tracking/rollout_measures prowl::tracking)
prowl_test(tracking/displaced_start prowl::tracking)

# The Riccati solution against SciPy: a program writes what the backward pass sees, a script solves it in its own way.
add_executable(tracking_print_design ${CMAKE_CURRENT_LIST_DIR}/print_design.cpp)
target_link_libraries(tracking_print_design PRIVATE prowl::prowl fmt::fmt)
target_compile_definitions(tracking_print_design PRIVATE
  PROWL_SOURCE_DIR="${PROJECT_SOURCE_DIR}" PROWL_ROBOTS_DATA="${PROWL_CMEEL}/share")
add_test(NAME tracking/riccati_scipy
  COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/riccati_scipy_test.py $<TARGET_FILE:tracking_print_design>)
set_tests_properties(tracking/riccati_scipy PROPERTIES ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1")
