# PBF_SANITIZE: GCC's or clang's sanitizers over everything; findings end the program.
if(PBF_SANITIZE)
  add_compile_options(-fsanitize=${PBF_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${PBF_SANITIZE})
endif()
