prowl_test(tracker/tracker prowl::tracker prowl::model)
prowl_test(tracker/tracker_file prowl::plan_folder)
