prowl_test(trajectory/trajectory prowl::trajectory)
prowl_test(trajectory/tracking_error prowl::trajectory)
