prowl_test(solvers/guarded_nlp prowl::solvers)
prowl_test(solvers/ipopt_solver prowl::solvers)
prowl_test(solvers/fatrop_solver prowl::solvers)
