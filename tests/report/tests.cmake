# The page of prowl report in a browser: report/tests, by Playwright. Reports and pictures stay in build/report.
if(TARGET report_page)
  add_test(NAME report/types COMMAND ${PROWL_VENV}/bin/node node_modules/typescript/bin/tsc --noEmit
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}/report)
  add_test(NAME report/browser COMMAND ${PROWL_VENV}/bin/node node_modules/@playwright/test/cli.js test
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}/report)
  set_tests_properties(report/browser PROPERTIES TIMEOUT 1800
    ENVIRONMENT "PROWL_COMMAND=$<TARGET_FILE:prowl_cli>;PROWL_REPORT_WORK=${PROJECT_BINARY_DIR}/report;OPENBLAS_NUM_THREADS=1")
elseif(PROWL_BUILD_CLI)
  message(STATUS "Prowl: without the tests of prowl report")
endif()
