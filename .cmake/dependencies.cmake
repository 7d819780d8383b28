# Kept libraries, from the distribution's packages (tools/setup installs them).
find_package(Threads REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(HDF5 REQUIRED COMPONENTS C)
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)

add_library(pbf_dependencies INTERFACE)
if(TARGET yaml-cpp::yaml-cpp)  # 0.8 and later
  set(PBF_YAML yaml-cpp::yaml-cpp)
else()
  set(PBF_YAML yaml-cpp)
endif()
target_link_libraries(pbf_dependencies INTERFACE
  Threads::Threads OpenMP::OpenMP_CXX hdf5::hdf5 ${PBF_YAML} CLI11::CLI11 Eigen3::Eigen
  ${CMAKE_DL_LIBS})
if(PBF_RENDER)
  find_package(PNG REQUIRED)
  target_link_libraries(pbf_dependencies INTERFACE PNG::PNG)
endif()
