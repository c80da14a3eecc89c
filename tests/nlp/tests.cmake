prowl_test(nlp/nlp_solver prowl::nlp)
prowl_test(nlp/constraint_violation prowl::nlp)
prowl_test(nlp/derivative_check prowl::nlp)
prowl_test(nlp/thread_team prowl::nlp)
