# The checks of pages and what the package's build does beside compiling: Python's own unittest, nothing to fetch.
find_package(Python 3.11 REQUIRED COMPONENTS Interpreter)
add_test(NAME script_tests WORKING_DIRECTORY "${CMAKE_CURRENT_LIST_DIR}"
  COMMAND "${Python_EXECUTABLE}" -B -m unittest discover -v -p "test_*.py")
set_tests_properties(script_tests PROPERTIES TIMEOUT 1200 LABELS scripts)
set(environment "GLISSON_BUILD=${PROJECT_BINARY_DIR}")
if(TARGET glisson_program)
  list(APPEND environment "GLISSON_PROGRAM=$<TARGET_FILE:glisson_program>")
endif()
set_tests_properties(script_tests PROPERTIES ENVIRONMENT "${environment}")
