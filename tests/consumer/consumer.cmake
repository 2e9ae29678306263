# The test `consumer_package`, for builds whose libraries a plain program can link (no sanitizer in them).
if(GLISSON_INSTALL AND NOT GLISSON_SANITIZE)
  set(components)
  foreach(component mesher heat image scene io fit)
    if(TARGET glisson_${component})
      list(APPEND components ${component})
    endif()
  endforeach()
  list(JOIN components "," components)
  add_test(NAME consumer_package
    COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DCONSUMER=${CMAKE_CURRENT_LIST_DIR}
      -DWORK=${PROJECT_BINARY_DIR}/consumer -DCOMPONENTS=${components} -DCXX=${CMAKE_CXX_COMPILER}
      -DBUILD_TYPE=${CMAKE_BUILD_TYPE} -P ${CMAKE_CURRENT_LIST_DIR}/run.cmake)
  set_tests_properties(consumer_package PROPERTIES TIMEOUT 300)
endif()
