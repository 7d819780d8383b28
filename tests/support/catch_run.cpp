// All of Catch2 2.13, compiled once; of 3, which is a library, only its session.
#define CATCH_CONFIG_RUNNER
#include "tests/support/catch.h"

int run_catch(int argc, char** argv) { return Catch::Session().run(argc, argv); }
