# Linking a static archive by name in place of what an imported target names.
# pbf_find_archive(VAR NAME): the path of libNAME.a, from the compiler's own folder or the system's.
function(pbf_find_archive var name)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=lib${name}.a
                  OUTPUT_VARIABLE path OUTPUT_STRIP_TRAILING_WHITESPACE)
  get_filename_component(folder "${path}" DIRECTORY)  # empty when the compiler does not know it
  find_library(PBF_ARCHIVE_${name} NAMES lib${name}.a HINTS ${folder} PATH_SUFFIXES hdf5/serial)
  if(NOT PBF_ARCHIVE_${name})
    message(FATAL_ERROR "this build links lib${name}.a and found none: install the development "
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
