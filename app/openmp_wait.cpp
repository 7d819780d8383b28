// Makes OpenMP threads sleep, not spin, while they wait for the next loop. On a machine whose cores
// are shared (another job, the thread that draws pictures) spinning threads take the cores from
// those with work: measured 5 times slower. Whoever wants them to spin sets OMP_WAIT_POLICY.
#include <cstdlib>

namespace {

void sleep_while_waiting(int, char**, char**) { setenv("OMP_WAIT_POLICY", "passive", 0); }

// The OpenMP runtime reads the variable when it is loaded, before main(): so does this run,
// earlier.
[[gnu::section(".preinit_array"), gnu::used]] void (*const run_first)(int, char**,
                                                                      char**) = sleep_while_waiting;

}  // namespace
