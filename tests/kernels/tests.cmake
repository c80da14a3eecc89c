prowl_test(kernels/dense_kernels prowl::kernels Eigen3::Eigen)
add_test(NAME kernels/symbols COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/kernels/symbols_test.py
  $<TARGET_OBJECTS:prowl_kernels> COMMAND_EXPAND_LISTS)
add_test(NAME kernels/instruction_sets COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/kernels/instruction_sets_test.py
  $<TARGET_FILE:prowl_cli>)
