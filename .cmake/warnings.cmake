# Warnings for our own sources.
add_library(pbf_warnings INTERFACE)
target_compile_options(pbf_warnings INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wno-unknown-pragmas -Wno-psabi>)
option(PBF_WERROR "Treat warnings as errors" OFF)
if(PBF_WERROR)
  target_compile_options(pbf_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()
