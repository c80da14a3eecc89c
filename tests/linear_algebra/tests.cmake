prowl_test(linear_algebra/factorisations prowl::linear_algebra)
