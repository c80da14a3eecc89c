prowl_test(fuzz/seeds prowl::plan_folder prowl::report_page nlohmann_json::nlohmann_json)

# A short run of each fuzz target, built on one core beside other tests; scripts/test installs Clang. Without it the test is
# skipped, in CI it fails.
add_test(NAME fuzz/short COMMAND ${PROJECT_SOURCE_DIR}/scripts/fuzz --seconds 8)
set_tests_properties(fuzz/short PROPERTIES TIMEOUT 1500 SKIP_RETURN_CODE 77 ENVIRONMENT PROWL_JOBS=1)
