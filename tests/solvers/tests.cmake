prowl_test(solvers/guarded_nlp prowl::solvers)
prowl_test(solvers/ipopt_solver prowl::solvers)
prowl_test(solvers/chain_solvers prowl::solvers)
prowl_test(solvers/riccati_solver prowl::solvers)
prowl_test(solvers/stage_kkt prowl::solvers)
prowl_test(solvers/slacks prowl::solvers)
prowl_test(solvers/filter prowl::solvers)

# In place of the user's libsnopt7, which no test can have.
add_library(snopt_double SHARED ${CMAKE_CURRENT_LIST_DIR}/snopt_double.cpp)
prowl_test(solvers/snopt_solver prowl::solvers)
target_compile_definitions(solvers_snopt_solver_test PRIVATE PROWL_SNOPT_DOUBLE="$<TARGET_FILE:snopt_double>")
add_dependencies(solvers_snopt_solver_test snopt_double)
