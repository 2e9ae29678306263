# Language level, warnings, sanitizers and the compiler cache, for every target of the project.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(GLISSON_CCACHE ccache)
if(GLISSON_CCACHE)
  # Paths below the source folder are made relative before they are hashed, so that a second clone finds what the first compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}" CCACHE_NOHASHDIR=1
    "CCACHE_IGNOREOPTIONS=--param=ggc-min-heapsize=*" "${GLISSON_CCACHE}")  # an option of memory alone
endif()

add_library(glisson_options INTERFACE)
target_compile_features(glisson_options INTERFACE cxx_std_20)
# No fused multiply-add behind our back: the same source gives the same bytes in every translation unit.
target_compile_options(glisson_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -ffp-contract=off)
# GCC 12 and 13 see overlaps in std::string that are not there (GCC bug 105651).
target_compile_options(glisson_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# GCC looks for garbage in its memory from 128 MiB on, again and again in a file of a GiB: a tenth of the time to compile. From
# 1 GiB on it costs little; the largest file takes 0.4 GiB more.
target_compile_options(glisson_options INTERFACE
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:--param=ggc-min-heapsize=1048576>)
# __FILE__, which every check of GoogleTest has, without the folder of this clone: else the cache knows no test of another one.
target_compile_options(glisson_options INTERFACE "-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=")
if(GLISSON_SANITIZE)
  target_compile_options(glisson_options INTERFACE -fsanitize=${GLISSON_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # GCC's manual: with a sanitizer this one warns of what is not so.
  target_compile_options(glisson_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  # The address sanitizer sees what three of these do, and no pointer is cast to a type of larger alignment: two fifths of the time
  # to compile.
  if(GLISSON_SANITIZE MATCHES "address.*undefined")
    target_compile_options(glisson_options INTERFACE -fno-sanitize=null,object-size,pointer-overflow,alignment)
  endif()
  target_link_options(glisson_options INTERFACE -fsanitize=${GLISSON_SANITIZE})
  # Under the address sanitizer Eigen aligns memory by hand, unlike the Eigen inside the packaged Ceres: one would free what the
  # other took. The sanitizer's malloc is aligned to 16 bytes like glibc's, so both may use it.
  target_compile_definitions(glisson_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

# What io takes from VTK; the installed package asks for the same.
set(GLISSON_VTK_COMPONENTS CommonCore CommonDataModel CommonExecutionModel IOCore IOXML IOXMLParser)
