prowl_test(elastic/elastic_solve prowl::elastic prowl::solvers prowl::ipopt)
