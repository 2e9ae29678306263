# Force curves of shipped scenes against the curves kept here (curves.json); what differs is written to golden-different.
if(TARGET glisson_program)
  find_package(Python 3.11 REQUIRED COMPONENTS Interpreter)
  add_test(NAME golden_curves
    COMMAND "${Python_EXECUTABLE}" -B "${PROJECT_SOURCE_DIR}/scripts/golden_curves" "$<TARGET_FILE:glisson_program>"
            --different "${PROJECT_BINARY_DIR}/golden-different")
  set_tests_properties(golden_curves PROPERTIES TIMEOUT 600 LABELS scripts)
endif()
