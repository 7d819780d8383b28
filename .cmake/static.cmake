# PBF_STATIC, for tools/bundle: everything but glibc goes into the executables, by the names of the
# archives. The imported targets name shared libraries, and HDF5's also names curl and crypto: only
# its S3 driver needs these (H5FDros3.o, H5FDs3comms.o), which no other object of the archive refers
# to, so that the link leaves them out. With an HDF5 that refers to them the link fails and says so.
# CUDA's runtime is static in every build. What is opened at run time (GL, the driver) stays so.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  message(FATAL_ERROR "PBF_STATIC=ON is written for g++ and its libgomp, not for "
                      "${CMAKE_CXX_COMPILER_ID}: pass -DCMAKE_CXX_COMPILER=g++")
endif()

# pbf_find_archive(VAR NAME): the path of libNAME.a, from the compiler's own folder or the system's.
function(pbf_find_archive var name)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=lib${name}.a
                  OUTPUT_VARIABLE path OUTPUT_STRIP_TRAILING_WHITESPACE)
  get_filename_component(folder "${path}" DIRECTORY)  # empty when the compiler does not know it
  find_library(PBF_ARCHIVE_${name} NAMES lib${name}.a HINTS ${folder} PATH_SUFFIXES hdf5/serial)
  if(NOT PBF_ARCHIVE_${name})
    message(FATAL_ERROR "PBF_STATIC=ON needs lib${name}.a and found none: install the development "
                        "package that holds it (on Debian: apt-file search lib${name}.a)")
  endif()
  mark_as_advanced(PBF_ARCHIVE_${name})
  set(${var} ${PBF_ARCHIVE_${name}} PARENT_SCOPE)
endfunction()

# pbf_link_archives(TARGET NAME...): compiles as the imported target asks, links libNAME.a.
function(pbf_link_archives target)
  target_compile_options(pbf_dependencies INTERFACE
    $<TARGET_PROPERTY:${target},INTERFACE_COMPILE_OPTIONS>)
  target_include_directories(pbf_dependencies SYSTEM INTERFACE
    $<TARGET_PROPERTY:${target},INTERFACE_INCLUDE_DIRECTORIES>)
  foreach(name IN LISTS ARGN)
    pbf_find_archive(archive ${name})
    target_link_libraries(pbf_dependencies INTERFACE ${archive})
  endforeach()
endfunction()

# Nothing of the archives is exported: a library that is opened later keeps its own libstdc++.
add_link_options(-static-libstdc++ -static-libgcc LINKER:--exclude-libs,ALL)
# Messages name sources from the root of the repository, wherever the bundle was built.
set(map -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
add_compile_options($<$<COMPILE_LANGUAGE:CXX>:${map}> $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=${map}>)
