prowl_test(motion/motion_problem prowl::motion)
