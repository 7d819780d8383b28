# The font of pictures: stb_truetype draws it, and lib/render/font/ is compiled into the program.
find_path(PBF_STB_INCLUDE_DIR stb/stb_truetype.h
          DOC "Folder that holds stb/stb_truetype.h (package libstb-dev)")
if(NOT PBF_STB_INCLUDE_DIR)
  message(FATAL_ERROR "stb/stb_truetype.h, which draws the text on pictures, was not found: "
                      "install libstb-dev (tools/setup does), pass -DPBF_STB_INCLUDE_DIR=FOLDER, or build "
                      "without pictures with -DPBF_RENDER=OFF")
endif()
set(PBF_FONT ${PROJECT_SOURCE_DIR}/lib/render/font)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PBF_FONT}/DejaVuSans-Latin1.ttf)
file(READ ${PBF_FONT}/DejaVuSans-Latin1.ttf bytes HEX)
string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
set(PBF_FONT_SOURCE ${PROJECT_BINARY_DIR}/generated/font_data.cpp)
file(CONFIGURE OUTPUT ${PBF_FONT_SOURCE} @ONLY CONTENT
"// lib/render/font/DejaVuSans-Latin1.ttf, made by .cmake/font.cmake.
#include \"lib/render/font.h\"

namespace pbf::render_module {

const unsigned char kFontData[] = {
@bytes@};

}  // namespace pbf::render_module
")

function(pbf_embed_font target)
  target_sources(${target} PRIVATE ${PBF_FONT_SOURCE})
  target_include_directories(${target} SYSTEM PRIVATE ${PBF_STB_INCLUDE_DIR})
endfunction()
