# The report page on a real run: the program writes a report of the paper's figure 2, a browser opens it.
if(TARGET glisson_program)
  set(report_dir "${PROJECT_BINARY_DIR}/report-under-test")
  add_test(NAME real_report_made
    COMMAND glisson_program run "${PROJECT_SOURCE_DIR}/scenes/paper/figure2.toml" --out "${report_dir}" --quiet)
  add_test(NAME real_report_in_browser
    COMMAND "${GLISSON_NODE}" "${PROJECT_SOURCE_DIR}/tests/browser/run.mjs" "${PROJECT_SOURCE_DIR}/tests/browser/report.test.mjs")
  set_tests_properties(real_report_made PROPERTIES TIMEOUT 300 FIXTURES_SETUP real_report)
  set_tests_properties(real_report_in_browser PROPERTIES TIMEOUT 300 SKIP_RETURN_CODE 77 LABELS web RUN_SERIAL ON FIXTURES_REQUIRED real_report
    ENVIRONMENT "GLISSON_WEB_DIR=${PROJECT_BINARY_DIR}/web/page;GLISSON_REPORT=${report_dir}/report.html")
endif()
