prowl_test(simulation/physics prowl::simulation pinocchio::pinocchio_default)
