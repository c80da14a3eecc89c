prowl_test(online/online_run prowl::online)
prowl_test(online/script_file prowl::online)
prowl_test(online/benchmark prowl::online)
prowl_test(online/force_check prowl::online)
