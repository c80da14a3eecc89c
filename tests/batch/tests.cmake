prowl_test(batch/job prowl::batch)
prowl_test(batch/key_path prowl::batch tomlplusplus::tomlplusplus)
