# One translation unit a room: the files of a folder are compiled together, so that headers are read and templates are made
# once a folder. Names of a file's own (anonymous namespace) are therefore unique in a folder. -DGLISSON_UNITY=OFF compiles
# file by file: shorter waits where one file is edited over and over.
option(GLISSON_UNITY "Compile the files of a folder together" ON)

# glisson_unity(target [APART files...] [TOGETHER regexes...]): files under APART keep a translation unit of their own; the
# folders that one regex matches share one, because a small folder spends most of its time on headers. Names of a file's own
# are then unique in all of them.
function(glisson_unity target)
  cmake_parse_arguments(arg "" "" "APART;TOGETHER" ${ARGN})
  if(NOT GLISSON_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source)
    cmake_path(IS_PREFIX PROJECT_SOURCE_DIR "${source}" ours)
    cmake_path(RELATIVE_PATH source BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" OUTPUT_VARIABLE name)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR "${source}" made)
    if(NOT ours OR made OR NOT source MATCHES "[.]cpp$" OR name IN_LIST arg_APART)
      continue()
    endif()
    cmake_path(GET name PARENT_PATH room)
    foreach(shared IN LISTS arg_TOGETHER)
      if(room MATCHES "${shared}")
        string(REGEX REPLACE "[^a-z]+" "_" room "${shared}")
      endif()
    endforeach()
    string(REPLACE "/" "_" room "${room}")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${target}_${room}")
  endforeach()
endfunction()
