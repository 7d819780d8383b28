# PBF_STATIC, for tools/bundle: everything but glibc goes into the executables, by the names of the
# archives. The imported targets name shared libraries, and HDF5's also names curl and crypto: only
# its S3 driver needs these (H5FDros3.o, H5FDs3comms.o), which no other object of the archive refers
# to, so that the link leaves them out. With an HDF5 that refers to them the link fails and says so.
# CUDA's runtime is static in every build. What is opened at run time (GL, the driver) stays so.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  message(FATAL_ERROR "PBF_STATIC=ON is written for g++ and its libgomp, not for "
                      "${CMAKE_CXX_COMPILER_ID}: pass -DCMAKE_CXX_COMPILER=g++")
endif()

# Nothing of the archives is exported: a library that is opened later keeps its own libstdc++.
add_link_options(-static-libstdc++ -static-libgcc LINKER:--exclude-libs,ALL)
# Messages name sources from the root of the repository, wherever the bundle was built.
set(map -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
add_compile_options($<$<COMPILE_LANGUAGE:CXX>:${map}> $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=${map}>)
