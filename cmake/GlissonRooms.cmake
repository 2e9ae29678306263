# Rooms: what the sources of a folder may include. A room's headers are found through a folder of their own below build/…/rooms,
#
#   rooms/mesh/mesh/              → src/mesh
#   rooms/mesh/glisson/mesh.h     → include/glisson/mesh.h, and its other public headers
#
# and a room is compiled with the folders of itself, of the rooms it touches and of those that these touch: an include of any other
# header is not found. src/CMakeLists.txt has the rooms in their order; scripts/check_rooms says in words what breaks a wall.
define_property(GLOBAL PROPERTY glisson_rooms BRIEF_DOCS "The rooms that were declared, bottom up")
define_property(GLOBAL PROPERTY glisson_headers_with_a_room BRIEF_DOCS "Public headers that belong to a room")

# glisson_room(NAME [FOLDER folder] [TOUCHES rooms...] [PUBLIC patterns...]) declares a room: the target room_NAME carries its headers
# and, by its links, those of the rooms it touches. FOLDER: where it lies, src/NAME unless given. PUBLIC: its headers below
# include/glisson, without those of the rooms declared before.
function(glisson_room name)
  cmake_parse_arguments(arg "" "FOLDER" "TOUCHES;PUBLIC" ${ARGN})
  if(NOT arg_FOLDER)
    set(arg_FOLDER "src/${name}")
  endif()
  set(root "${PROJECT_BINARY_DIR}/rooms/${name}")
  file(GLOB_RECURSE old LIST_DIRECTORIES FALSE "${root}/glisson/*")
  if(old)
    file(REMOVE ${old})  # links that an earlier order made
  endif()
  file(MAKE_DIRECTORY "${root}")
  file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${arg_FOLDER}" "${root}/${name}" SYMBOLIC)

  set(include "${PROJECT_SOURCE_DIR}/include/glisson")
  list(TRANSFORM arg_PUBLIC PREPEND "${include}/")
  set(headers "")
  if(arg_PUBLIC)
    file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE "${include}" ${arg_PUBLIC})
  endif()
  get_property(taken GLOBAL PROPERTY glisson_headers_with_a_room)
  list(REMOVE_ITEM headers ${taken})
  foreach(header IN LISTS headers)
    cmake_path(GET header PARENT_PATH folder)
    file(MAKE_DIRECTORY "${root}/glisson/${folder}")
    file(CREATE_LINK "${include}/${header}" "${root}/glisson/${header}" SYMBOLIC)
  endforeach()
  set_property(GLOBAL APPEND PROPERTY glisson_headers_with_a_room ${headers})
  set_property(GLOBAL APPEND PROPERTY glisson_rooms ${name})

  add_library(room_${name} INTERFACE)
  target_include_directories(room_${name} INTERFACE "$<BUILD_INTERFACE:${root}>")
  list(TRANSFORM arg_TOUCHES PREPEND "room_")
  target_link_libraries(room_${name} INTERFACE ${arg_TOUCHES})
endfunction()

# Each public header belongs to a room, so that no room sees those of another by chance.
function(glisson_check_public_headers)
  file(GLOB_RECURSE all CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}/include/glisson" "${PROJECT_SOURCE_DIR}/include/glisson/*.h")
  get_property(taken GLOBAL PROPERTY glisson_headers_with_a_room)
  list(REMOVE_ITEM all glisson.h ${taken})  # which includes those of all
  if(all)
    list(JOIN all ", " all)
    message(FATAL_ERROR "include/glisson: no room has ${all}; src/CMakeLists.txt says under PUBLIC which room has which headers")
  endif()
endfunction()

# glisson_sources(out ROOM [FOLDER folder] [EXCEPT regex] [ONLY regex]): the sources of a room
function(glisson_sources out name)
  cmake_parse_arguments(arg "" "FOLDER;EXCEPT;ONLY" "" ${ARGN})
  if(NOT arg_FOLDER)
    set(arg_FOLDER "src/${name}")
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${arg_FOLDER}/*.cpp")
  if(arg_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "${arg_EXCEPT}")
  endif()
  if(arg_ONLY)
    list(FILTER sources INCLUDE REGEX "${arg_ONLY}")
  endif()
  set(${out} "${sources}" PARENT_SCOPE)
endfunction()

# glisson_room_objects(NAME [LIBRARIES ...] [APART ...] [TOGETHER ...]): the target glisson_NAME, compiled behind the room's walls. The
# others as in glisson_unity.
function(glisson_room_objects name)
  cmake_parse_arguments(arg "" "" "LIBRARIES;APART;TOGETHER" ${ARGN})
  glisson_sources(sources ${name})
  add_library(glisson_${name} OBJECT ${sources})
  glisson_unity(glisson_${name} APART ${arg_APART} TOGETHER ${arg_TOGETHER})
  target_link_libraries(glisson_${name} PRIVATE room_${name} glisson_options ${arg_LIBRARIES})
endfunction()
