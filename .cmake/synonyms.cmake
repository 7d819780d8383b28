# lib/scene/synonyms.yaml is compiled into the program: messages about unknown keys need no file, so
# they are the same wherever the program lies.
set(PBF_SYNONYMS ${PROJECT_SOURCE_DIR}/lib/scene/synonyms.yaml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PBF_SYNONYMS})
file(READ ${PBF_SYNONYMS} text)
set(PBF_SYNONYM_SOURCE ${PROJECT_BINARY_DIR}/generated/synonym_text.cpp)
file(CONFIGURE OUTPUT ${PBF_SYNONYM_SOURCE} @ONLY CONTENT
"// lib/scene/synonyms.yaml, made by .cmake/synonyms.cmake.
#include \"lib/scene/suggest.h\"

namespace pbf::scene_module {

const char* const kSynonymText = R\"yaml(@text@)yaml\";

}  // namespace pbf::scene_module
")
target_sources(pbf_lib PRIVATE ${PBF_SYNONYM_SOURCE})
