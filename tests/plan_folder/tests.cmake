prowl_test(plan_folder/plan_folder prowl::plan_folder nlohmann_json::nlohmann_json)
prowl_test(plan_folder/mujoco_keyframes prowl::plan_folder prowl_dep_mujoco)
prowl_test(plan_folder/mujoco_visuals prowl::plan_folder prowl_dep_mujoco)
