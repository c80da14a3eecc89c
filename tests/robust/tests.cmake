prowl_test(robust/tube prowl::prowl)
prowl_test(robust/robust_plan prowl::prowl)
