# Kept libraries, from the distribution's packages (tools/setup installs them).
find_package(Threads REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(HDF5 REQUIRED COMPONENTS C)
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt 9 QUIET)
if(NOT fmt_FOUND)
  message(FATAL_ERROR "{fmt} 9 or later, which formats the texts of the program, was not found: "
                      "install libfmt-dev (tools/setup does), or pass -Dfmt_ROOT=FOLDER")
endif()

add_library(pbf_dependencies INTERFACE)
if(TARGET yaml-cpp::yaml-cpp)  # 0.8 and later
  set(PBF_YAML yaml-cpp::yaml-cpp)
else()
  set(PBF_YAML yaml-cpp)
endif()
target_link_libraries(pbf_dependencies INTERFACE
  Threads::Threads CLI11::CLI11 nlohmann_json::nlohmann_json ${CMAKE_DL_LIBS})

include(${CMAKE_CURRENT_LIST_DIR}/archives.cmake)
if(PBF_STATIC)
  include(${CMAKE_CURRENT_LIST_DIR}/static.cmake)
endif()
# pbf_link(TARGET ARCHIVE...): links the imported target; with PBF_STATIC its archives by name.
function(pbf_link target)
  if(PBF_STATIC)
    pbf_link_archives(${target} ${ARGN})
  else()
    target_link_libraries(pbf_dependencies INTERFACE ${target})
  endif()
endfunction()

# GCC's OpenMP runtime is linked statically in every build: it reads its environment in a constructor,
# before which only one of the program itself can run (lib/program/threads.cpp). Nothing of it is
# exported, so that a library which brings its own keeps that.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  pbf_link_archives(OpenMP::OpenMP_CXX gomp)
  add_link_options(LINKER:--exclude-libs,libgomp.a)
else()
  pbf_link(OpenMP::OpenMP_CXX gomp)
endif()
pbf_link(hdf5::hdf5 hdf5 sz aec z)
pbf_link(${PBF_YAML} yaml-cpp)
if(PBF_STATIC)  # Debian has no libfmt.a
  target_link_libraries(pbf_dependencies INTERFACE fmt::fmt-header-only)
else()
  target_link_libraries(pbf_dependencies INTERFACE fmt::fmt)
endif()
if(PBF_RENDER)
  find_package(PNG REQUIRED)
  pbf_link(PNG::PNG png z)
endif()
