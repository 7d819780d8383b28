# The sources of one folder are compiled as one, so that each header is parsed once per folder and
# not once per source. Names in anonymous namespaces must therefore differ inside a folder. OFF
# compiles every source by itself, which shows a missing include.
option(PBF_UNITY "Compile the sources of a folder together" ON)
function(pbf_unity target)  # pbf_unity(target): after the target has all its sources
  get_target_property(sources ${target} SOURCES)
  # Those that take long to optimise would hold up their folder.
  list(FILTER sources EXCLUDE REGEX "/lib/exec/cpu/|/tests/oracle/(active_set|exact_projection)\\.cpp$")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    string(MAKE_C_IDENTIFIER "${folder}" group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
  # A source without a group is compiled by itself.
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${PBF_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()
