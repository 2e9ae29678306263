# Writes build_info.h: what a benchmark's figures depend on and only the build knows. Run at every build, as the commit
# changes without CMake's notice; the file is touched only where its text changes.
#   cmake -DSOURCE=… -DTEMPLATE=… -DOUT=… -DCOMPILER=… -DFLAGS=… -P build_info.cmake
execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty --abbrev=12 --exclude "*"
  OUTPUT_VARIABLE COMMIT RESULT_VARIABLE result OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT result EQUAL 0)
  set(COMMIT unknown)
endif()
configure_file("${TEMPLATE}" "${OUT}" @ONLY)
