prowl_test(starter/sole prowl::starter)
