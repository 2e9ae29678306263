# Libraries that another build folder of these sources holds already, in place of compiling them again: what `pip install .`
# takes from the build/release of `make run`.
#
#   build/release:  glisson_offer_libraries()       writes glisson_libraries.cmake, the libraries as imported targets, and
#                                                   glisson_libraries.txt, all that their bytes depend on beside the sources
#   the wheel:      glisson_reuse_libraries(FOLDER) where that text is ours, too: brings them up to date by the folder's own
#                                                   build and imports them; GLISSON_REUSED says whether
#
# A folder that is absent, half made, of another compiler, version, flags or libraries, or that cannot be built, is left alone
# and everything is compiled here.
set(glisson_offered glisson_options glisson glisson_heat glisson_mesher glisson_image glisson_scene glisson_io glisson_fit glisson_report glisson_fit_files)

function(glisson_describe_build out)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  file(REAL_PATH "${CMAKE_CXX_COMPILER}" compiler)  # c++ and g++ are often the same
  set(text "")
  foreach(name CMAKE_SOURCE_DIR CMAKE_SYSTEM_PROCESSOR compiler CMAKE_CXX_COMPILER_ID CMAKE_CXX_COMPILER_VERSION
      CMAKE_BUILD_TYPE CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_${type} CMAKE_INTERPROCEDURAL_OPTIMIZATION GLISSON_SANITIZE
      Eigen3_DIR hwy_DIR TBB_DIR tomlplusplus_DIR ZLIB_LIBRARY VTK_DIR Ceres_DIR nlohmann_json_DIR fmt_DIR)
    string(APPEND text "${name}=${${name}}\n")
  endforeach()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

function(glisson_offer_libraries)
  get_property(rooms GLOBAL PROPERTY glisson_rooms)
  list(TRANSFORM rooms PREPEND "room_")
  foreach(target IN LISTS glisson_offered)
    if(NOT TARGET ${target})
      return()
    endif()
  endforeach()
  glisson_describe_build(ours)
  file(WRITE "${PROJECT_BINARY_DIR}/glisson_libraries.txt" "${ours}")
  export(TARGETS ${glisson_offered} ${rooms} NAMESPACE built:: FILE "${PROJECT_BINARY_DIR}/glisson_libraries.cmake")
endfunction()

# glisson_same_build(FOLDER out): whether what FOLDER offers is what would be compiled here
function(glisson_same_build folder out)
  set(${out} FALSE PARENT_SCOPE)
  if(EXISTS "${folder}/glisson_libraries.txt" AND EXISTS "${folder}/glisson_libraries.cmake")
    glisson_describe_build(ours)
    file(READ "${folder}/glisson_libraries.txt" theirs)
    if(theirs STREQUAL ours)
      set(${out} TRUE PARENT_SCOPE)
    endif()
  endif()
endfunction()

# The exported names are those of the installed package where there is one: built::scene for glisson_scene.
macro(glisson_import_libraries folder)
  include("${folder}/glisson_libraries.cmake")
  foreach(target IN LISTS glisson_offered)
    string(REPLACE "glisson_" "" short ${target})
    if(target STREQUAL "glisson_options")
      continue()
    elseif(TARGET built::${target})
      add_library(${target} ALIAS built::${target})
    else()
      add_library(${target} ALIAS built::${short})
    endif()
  endforeach()
  foreach(room IN ITEMS base)  # whose helpers the modules use
    add_library(room_${room} ALIAS built::room_${room})
  endforeach()
endmacro()

# glisson_moved_from(FOLDER out): where the sources were that FOLDER was built of, if that is another place than this; else empty
function(glisson_moved_from folder out)
  set(${out} "" PARENT_SCOPE)
  if(EXISTS "${folder}/glisson_libraries.txt")
    file(STRINGS "${folder}/glisson_libraries.txt" of REGEX "^CMAKE_SOURCE_DIR=")
    string(REPLACE "CMAKE_SOURCE_DIR=" "" of "${of}")
    if(NOT of STREQUAL CMAKE_SOURCE_DIR)
      set(${out} "${of}" PARENT_SCOPE)
    endif()
  endif()
endfunction()

macro(glisson_reuse_libraries folder)
  set(GLISSON_REUSED FALSE)
  glisson_same_build("${folder}" same)
  if(same)
    message(STATUS "libraries: those of ${folder}, brought up to date there")
    execute_process(COMMAND "${CMAKE_COMMAND}" --build "${folder}" --target glisson_fit_files RESULT_VARIABLE result
      OUTPUT_VARIABLE output ERROR_VARIABLE output)
    glisson_same_build("${folder}" same)  # that build may have configured itself anew
    if(result EQUAL 0 AND same)
      glisson_import_libraries("${folder}")
      set(GLISSON_REUSED TRUE)
    endif()
  endif()
  glisson_moved_from("${folder}" moved)
  if(moved)
    message(STATUS "libraries: compiled here; ${folder} was built of the sources in ${moved}: this tree was moved or "
      "copied. `make run` builds it anew, and then they are taken from there")
  elseif(NOT GLISSON_REUSED)
    message(STATUS "libraries: compiled here; ${folder} has none of this compiler, its flags and these packages")
  endif()
endmacro()
