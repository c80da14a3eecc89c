prowl_test(terms/angle_ratio prowl::terms)
prowl_test(terms/deviation prowl::terms)
prowl_test(terms/frame_terms prowl::terms)
prowl_test(terms/own_term prowl::terms)
