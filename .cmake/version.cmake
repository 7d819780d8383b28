# build/generated/pbf_build_info.h: what `pbf info` and every run file say about this build.
# The commit is looked up at build time; the header changes, and one source recompiles, only when
# the commit does.
find_package(Git QUIET)
foreach(lib IN ITEMS HDF5 yaml-cpp CLI11 nlohmann_json fmt PNG)
  string(MAKE_C_IDENTIFIER "PBF_VERSION_${lib}" var)
  set(${var} "${${lib}_VERSION}")
endforeach()
if(NOT PBF_VERSION_PNG)
  set(PBF_VERSION_PNG "${PNG_VERSION_STRING}")
endif()
string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} -ffp-contract=off -fno-math-errno"
       PBF_BUILD_FLAGS)
set(PBF_COMPILER "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
set(PBF_FEATURES "openmp")
if(PBF_RENDER)
  string(APPEND PBF_FEATURES " render")
endif()
set(PBF_VERSION_CUDART "")
if(PBF_HAS_CUDA)
  string(APPEND PBF_FEATURES " cuda")
  set(PBF_VERSION_CUDART "${CUDAToolkit_VERSION_MAJOR}.${CUDAToolkit_VERSION_MINOR}")
endif()
set(PBF_COMMIT "@PBF_COMMIT@")  # filled in by write_commit.cmake
configure_file(${CMAKE_CURRENT_LIST_DIR}/build_info.h.in
               ${PROJECT_BINARY_DIR}/build_info.h.in @ONLY)
add_custom_target(pbf_build_info
  COMMAND ${CMAKE_COMMAND} -DGIT=${GIT_EXECUTABLE} -DSOURCE_DIR=${PROJECT_SOURCE_DIR}
          -DTEMPLATE=${PROJECT_BINARY_DIR}/build_info.h.in
          -DOUTPUT=${PROJECT_BINARY_DIR}/generated/pbf_build_info.h
          -P ${CMAKE_CURRENT_LIST_DIR}/write_commit.cmake
  BYPRODUCTS ${PROJECT_BINARY_DIR}/generated/pbf_build_info.h
  COMMENT "Looking up the commit" VERBATIM)
