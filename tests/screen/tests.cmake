prowl_test(screen/check_table prowl::screen)
prowl_test(screen/mesh_advice prowl::screen)
prowl_test(screen/motion_sentence prowl::screen)
prowl_test(screen/phase_table prowl::screen nlohmann_json::nlohmann_json)
