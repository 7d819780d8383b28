# Run at build time by .cmake/version.cmake: fills the commit into the header, "unknown" outside a
# checkout, "+changes" when tracked files differ from it.
set(PBF_COMMIT unknown)
if(GIT)
  execute_process(COMMAND ${GIT} describe --always --abbrev=12 --exclude=* --dirty=+changes
                  WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE out RESULT_VARIABLE rc
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(rc EQUAL 0)
    set(PBF_COMMIT ${out})
  endif()
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
