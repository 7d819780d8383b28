#include "lib/base/machine.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace pbf::base_module {
namespace {

/// First number in a file; false when there is none ("max" in a control group without a limit).
bool read_number(const std::string& path, std::size_t& value) {
  std::ifstream in(path);
  return static_cast<bool>(in >> value);
}

/// The text after the colon in the line "name: ..."; empty when there is no such line.
std::string value_of(const char* file, const std::string& name) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(name)) return line.substr(line.find(':') + 1);
  return {};
}

/// "MemAvailable:   123 kB" -> bytes; 0 when there is no such line.
std::size_t memory_line(const char* file, const std::string& name) {
  const std::string value = value_of(file, name);
  return value.empty() ? 0 : std::stoull(value) * 1024;
}

}  // namespace

std::string cpu_model() {
  static const std::string value = value_of("/proc/cpuinfo", "model name");
  return value.size() > 1 ? value.substr(1) : "unknown CPU";
}

int usable_threads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return static_cast<int>(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));  // more than 1024 CPUs
}

std::size_t available_memory() {
  std::size_t free = memory_line("/proc/meminfo", "MemAvailable:");
  // Version 2 of control groups, as seen inside a container. Limits of a more deeply nested batch
  // job are not seen: there the allocation fails or the system ends the job.
  std::size_t limit = 0, used = 0;
  if (read_number("/sys/fs/cgroup/memory.max", limit) &&
      read_number("/sys/fs/cgroup/memory.current", used)) {
    const std::size_t left = limit > used ? limit - used : 0;
    free = free == 0 ? left : std::min(free, left);
  }
  return free;
}

std::size_t peak_memory() { return memory_line("/proc/self/status", "VmHWM:"); }

}  // namespace pbf::base_module
