prowl_test(report_page/report_file prowl::report_page nlohmann_json::nlohmann_json)
prowl_test(report_page/online_wish prowl::report_page)
