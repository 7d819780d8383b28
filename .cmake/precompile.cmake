# Headers of libraries that most sources read are parsed once per target: about a third of the CPU
# time of a build. OFF shows sources that lack an include.
option(PBF_PRECOMPILE "Precompile the headers of the standard library" ON)
function(pbf_precompile target)  # pbf_precompile(target HEADER...)
  if(PBF_PRECOMPILE)
    foreach(header algorithm array cmath cstdint cstring filesystem functional map memory optional
                   string vector)
      list(APPEND ARGN "$<$<COMPILE_LANGUAGE:CXX>:<${header}$<ANGLE-R>>")
    endforeach()
    target_precompile_headers(${target} PRIVATE ${ARGN})
    # GCC 12 no longer takes them for the system's, and its false alarms about std::string show.
    foreach(warning array-bounds restrict stringop-overflow stringop-overread)
      target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-${warning}>)
    endforeach()
  endif()
endfunction()
