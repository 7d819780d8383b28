#include "lib/cpu/cpu_exec.h"

namespace pbf {

void CpuExec::sort_by_cell(const int* cell, int n, int cells, int* order, int* start) {
  // Every thread counts and places its own contiguous share of the particles, in order: stable.
  const int threads = n > 16384 ? threads_ : 1;
  histogram_.assign(std::size_t(threads) * std::size_t(cells), 0);
#pragma omp parallel num_threads(threads)
  {
    const int t = omp_get_thread_num(), all = omp_get_num_threads();
    const int first = int(std::int64_t(n) * t / all), last = int(std::int64_t(n) * (t + 1) / all);
    int* mine = histogram_.data() + std::size_t(t) * std::size_t(cells);
    for (int i = first; i < last; ++i) ++mine[cell[i]];
#pragma omp barrier
#pragma omp single
    {
      int sum = 0;
      for (int c = 0; c < cells; ++c) {
        start[c] = sum;
        for (int k = 0; k < all; ++k) {
          int& h = histogram_[std::size_t(k) * std::size_t(cells) + std::size_t(c)];
          const int count = h;
          h = sum;
          sum += count;
        }
      }
      start[cells] = n;
    }
    for (int i = first; i < last; ++i) order[mine[cell[i]]++] = i;
  }
}

std::size_t CpuExec::list_bytes() const {
  std::size_t sum = begin_.bytes() + count_.bytes() + histogram_.capacity() * sizeof(int);
  for (const auto& c : chunks_) sum += c.bytes();
  for (const auto& s : scratch_) sum += s.capacity() * sizeof(int);
  return sum;
}

}  // namespace pbf
