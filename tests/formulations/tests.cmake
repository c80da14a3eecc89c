prowl_test(formulations/base_chart prowl::formulations)
prowl_test(formulations/collocation prowl::formulations)
prowl_test(formulations/order prowl::formulations prowl::solvers)
