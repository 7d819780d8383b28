# Release is the default: a debug build of the solver is 20 times slower.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, RelWithDebInfo or Debug" FORCE)
endif()
# No contraction: a*b+c rounds twice on every backend, so that the same scene gives the same bits.
# -O3 without -ffast-math for the same reason; -fno-math-errno lets sqrt become one instruction.
add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
                    $<$<COMPILE_LANGUAGE:CXX>:-fno-math-errno>)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
