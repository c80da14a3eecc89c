prowl_test(online/online_run prowl::online)
