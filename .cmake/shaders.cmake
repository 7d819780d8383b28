# build/generated/pbf_shaders.h: lib/render/shaders/NAME.glsl as the text pbf::shaders::NAME. Comments
# at the top of a file are left out.
file(GLOB shaders CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lib/render/shaders/*.glsl)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${shaders})
set(texts "")
foreach(shader IN LISTS shaders)
  cmake_path(GET shader STEM name)
  file(READ ${shader} text)
  string(REGEX REPLACE "^(//[^\n]*\n)+" "" text "${text}")
  string(APPEND texts "inline constexpr const char* ${name} = R\"glsl(${text})glsl\";\n")
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/pbf_shaders.h @ONLY CONTENT
"// lib/render/shaders, made by .cmake/shaders.cmake.
#pragma once

namespace pbf::render_module::shaders {

@texts@
}  // namespace pbf::render_module::shaders
")
