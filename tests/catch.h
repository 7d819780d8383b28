// Catch2 2.13 (Debian 12) and 3 (Ubuntu 24.04, Debian 13) through one include.
#pragma once
#ifdef PBF_CATCH3
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif
