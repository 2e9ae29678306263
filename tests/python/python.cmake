# The Python package: its wheel in a clean virtual environment, then its tests. Both keep what they fetch and build under
# the build folder. Not under sanitizers, which Python itself is not built with.
if(NOT TARGET glisson_program OR GLISSON_SANITIZE)
  return()
endif()
set(python_tests "${CMAKE_CURRENT_SOURCE_DIR}/python/run_tests.sh")
foreach(goal wheel tests)
  add_test(NAME python_${goal} COMMAND "${python_tests}" ${goal} "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}/python_tests"
    "$<TARGET_FILE:glisson_program>")
endforeach()
set_tests_properties(python_wheel PROPERTIES FIXTURES_SETUP python_wheel)
set_tests_properties(python_tests PROPERTIES FIXTURES_REQUIRED python_wheel)
# The same compiler by the same name, so that its cache has what the build has compiled.
set_tests_properties(python_wheel python_tests PROPERTIES LABELS python TIMEOUT 1800 COST 1000
  ENVIRONMENT "CC=${CMAKE_C_COMPILER};CXX=${CMAKE_CXX_COMPILER}")
