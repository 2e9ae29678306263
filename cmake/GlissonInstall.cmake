# What `cmake --install` lays down, and the package that find_package(Glisson) finds there.
#
#   bin/glisson   include/glisson/   lib/libglisson*.a   share/glisson/scenes/
#   lib/cmake/Glisson/: GlissonConfig, GlissonConfigVersion, one Glisson<component>Targets a component
#
# The core looks for Highway; the components `scene`, `io` and `fit` look for toml++, VTK and Ceres, `image` for zlib, `heat` and `mesher`
# for nothing more.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(glisson_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/Glisson")

# glisson_install_component(name target): libraries are exported one component to a file, so that a
# consumer of the core never loads a file that mentions VTK.
function(glisson_install_component name target)
  if(NOT TARGET ${target})
    return()
  endif()
  if(NOT name STREQUAL "core")
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  endif()
  install(TARGETS ${target} EXPORT Glisson_${name} ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(EXPORT Glisson_${name} NAMESPACE Glisson:: FILE Glisson_${name}_targets.cmake DESTINATION "${glisson_package_dir}")
endfunction()

glisson_install_component(core glisson)
glisson_install_component(heat glisson_heat)
glisson_install_component(mesher glisson_mesher)
glisson_install_component(image glisson_image)
glisson_install_component(scene glisson_scene)
glisson_install_component(io glisson_io)
glisson_install_component(fit glisson_fit)

install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/glisson" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" FILES_MATCHING PATTERN "*.h")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/scenes" DESTINATION "${CMAKE_INSTALL_DATADIR}/glisson")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
if(TARGET glisson_program)
  install(TARGETS glisson_program RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/GlissonConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/GlissonConfig.cmake" INSTALL_DESTINATION "${glisson_package_dir}" PATH_VARS CMAKE_INSTALL_DATADIR)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/GlissonConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/GlissonConfig.cmake" "${PROJECT_BINARY_DIR}/GlissonConfigVersion.cmake"
  DESTINATION "${glisson_package_dir}")
