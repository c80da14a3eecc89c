prowl_test(estimation/joint_filter prowl::estimation)
prowl_test(estimation/base_estimator prowl::estimation)
prowl_test(estimation/state_estimator prowl::estimation)
prowl_test(estimation/ground_estimator prowl::estimation)
