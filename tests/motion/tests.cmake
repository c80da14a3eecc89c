prowl_test(motion/motion_problem prowl::motion)
prowl_test(motion/cost prowl::motion)
prowl_test(motion/friction_cone prowl::motion)
prowl_test(motion/contact_schedule prowl::motion)
