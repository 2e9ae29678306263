# install_packages.cmake — npm ci in FOLDER, from npm's cache where it can; says what to do where it fails.
execute_process(
  COMMAND "${NPM}" ci --prefer-offline --no-audit --no-fund --loglevel=error
  WORKING_DIRECTORY "${FOLDER}" RESULT_VARIABLE result OUTPUT_QUIET)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "npm ci failed in ${FOLDER} (${result}). It needs a package registry or a filled cache once: "
    "check the network and npm's settings (npm config list), or build without the program: -DGLISSON_BUILD_APPS=OFF")
endif()
