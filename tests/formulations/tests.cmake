prowl_test(formulations/contact_motion prowl::formulations)
prowl_test(formulations/run_formulation prowl::prowl)
