# The libraries that the rooms of src/ are made with: scripts/packages.txt says what each is for.
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
find_package(hwy REQUIRED CONFIG)
find_package(TBB REQUIRED CONFIG)
find_package(tomlplusplus REQUIRED)
if(GLISSON_BUILD_IO)
  find_package(VTK 9 REQUIRED COMPONENTS ${GLISSON_VTK_COMPONENTS})
  find_library(GLISSON_DEFLATE deflate REQUIRED)  # it is linked by this name, here and by users of the installed package
endif()
if(GLISSON_BUILD_APPS OR GLISSON_BUILD_PYTHON)
  find_package(Ceres REQUIRED)
  find_package(nlohmann_json REQUIRED)
  find_package(fmt REQUIRED)
endif()
