prowl_test(mjcf/mjcf_robot prowl::mjcf prowl::dynamics prowl::simulation prowl_dep_mujoco)
