// With Catch2 3 main() comes from Catch2WithMain; with 2.13 it is made here, once.
#ifndef PBF_CATCH3
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
#else
namespace {
[[maybe_unused]] int unused;
}
#endif
