prowl_test(report_page/report_file prowl::report_page nlohmann_json::nlohmann_json)
