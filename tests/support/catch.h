// Catch2 2.13 (Debian 12) and 3 (Ubuntu 24.04, Debian 13) through one include.
#pragma once
#ifdef PBF_CATCH3
#include <catch2/catch_all.hpp>
using Catch::Approx;
namespace Catch {
inline auto Contains(const std::string& text) { return Matchers::ContainsSubstring(text); }
}  // namespace Catch
#else
#include <catch2/catch.hpp>
#endif

/// Runs the test cases that the arguments ask for; the exit code of main().
int run_catch(int argc, char** argv);

// Ends a test case that this machine cannot run. ctest reads the words "test skipped:" and reports
// it as skipped, not as passed; they win over a failure, so REQUIRE what must hold before.
#ifdef PBF_CATCH3
#define PBF_SKIP(why) SKIP("test skipped: " << why)
#else
#define PBF_SKIP(why)              \
  do {                             \
    WARN("test skipped: " << why); \
    return;                        \
  } while (false)
#endif
