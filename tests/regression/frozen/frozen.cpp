// Every shipped scene and every feature in small: the positions and velocities after 200 updates,
// as hashes, against those in hashes.csv. `frozen --help` says how to renew them.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <thread>
#include <vector>

#include "lib/base/error.h"
#include "lib/base/machine.h"
#include "lib/base/stage_clock.h"
#include "lib/campaign/stability.h"
#include "lib/campaign/study.h"
#include "lib/run/linked_files.h"
#include "lib/scene/load.h"
#include "tests/regression/frozen/hash.h"
#ifdef PBF_HAS_CUDA
#include "lib/exec/cuda/cuda_solver.h"
#endif

namespace {

using namespace pbf;
namespace fs = std::filesystem;

const fs::path kRoot = PBF_SOURCE_DIR;
const fs::path kHashes = kRoot / "tests/regression/frozen/hashes.csv";
constexpr int kUpdates = 200;
constexpr const char* kHead = "case,precision,particles,updates,position,velocity,readings";

struct Case {
  std::string name;
  fs::path file;
  std::vector<std::string> set;
  bool readings = false;
};

/// Those of the given names, or all.
std::vector<Case> read_cases(std::vector<std::string> names) {
  const bool all = names.empty();
  std::ifstream in(kRoot / "tests/regression/frozen/cases.txt");
  std::vector<Case> cases;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    Case c;
    std::string file;
    if (!(words >> c.name) || c.name[0] == '#' || !(words >> file)) continue;
    if (!all && std::erase(names, c.name) == 0) continue;
    c.file = kRoot / file;
    for (std::string word; words >> word;)
      if (word == "readings")
        c.readings = true;
      else
        c.set.push_back(word);
    cases.push_back(c);
  }
  for (const std::string& name : names)
    throw Error(ExitCode::bad_input, "cases.txt has no case " + name);
  return cases;
}

Scene scene_of(const Case& c, Precision precision, Backend backend) {
  const bool study = c.file.parent_path().filename() == "study";
  Scene s = study ? load_study(c.file.string(), c.set).members.front().scene
                  : load_scene(c.file.string(), c.set).scene;
  s.output.reset();
  s.render.reset();
  s.precision = precision;
  s.backend = backend;
  s.solver.reproducible = true;  // on a GPU the host's arithmetic; on a CPU it is so anyway
  s.time.end = kUpdates * s.time.step;
  return s;
}

std::string field_hash(const Snapshot& snapshot, const std::string& name) {
  for (const FieldArray& f : snapshot.fields)
    if (f.name == name) {
      test::Hash hash;
      hash.add({reinterpret_cast<const char*>(f.bytes.data()), f.bytes.size()});
      return hash.text();
    }
  return "none";
}

/// Of all loads at the last measure and what the gauges read since the start, to the last bit.
std::string readings_hash(const std::vector<double>& loads, const std::vector<double>& gauges) {
  test::Hash hash;
  const auto add = [&](double v) { hash.add({reinterpret_cast<const char*>(&v), sizeof v}); };
  for (const double v : loads) add(v);
  for (const double v : gauges) add(v);
  return hash.text();
}

/// "particles,updates,position,velocity", what follows case and precision in a row, and
/// ",readings" where they are wanted. Fewer updates than 200 where the guard ends the run.
std::string result_of(const Scene& s, const std::string& dir, bool readings) {
  std::string row;
  std::vector<double> gauges;
  const auto at_the_end = [&](Solver& solver) {
    gauges = solver.readings(Series::gauges, Interval::goes_on);
    const Snapshot snapshot =
        solver.download({"velocity"}, ScalarType::f64).get();  // in order of ids
    row = std::to_string(snapshot.count) + "," + std::to_string(solver.updates()) + "," +
          field_hash(snapshot, "position") + "," + field_hash(snapshot, "velocity");
  };
  const Course course = run_course(prepare(s, dir), {}, at_the_end).value();
  if (readings) row.append(",").append(readings_hash(course.last.readings, gauges));
  return row;
}

/// By "case,precision".
using Table = std::map<std::string, std::string>;

std::string key_of(const Case& c, Precision p) {
  return c.name + (p == Precision::dbl ? ",double" : ",float");
}

Table read_table() {
  std::ifstream in(kHashes);
  Table table;
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(',');
    const std::size_t second = first == line.npos ? first : line.find(',', first + 1);
    if (second != line.npos && line != kHead)
      table[line.substr(0, second)] = line.substr(second + 1);
  }
  return table;
}

struct Found {
  std::string row, note;  ///< note: what is wrong beside a different row
  double seconds = 0;
};

/// With one and with two threads where loops run on more than one; on a GPU once.
Found run_case(const Case& c, Precision precision, Backend backend) try {
  Scene s = scene_of(c, precision, backend);
  const std::string dir = c.file.parent_path().string();
  read_linked_files(s, dir);
  s.threads = 1;
  Found found{result_of(s, dir, c.readings), {}, 0};
  if (about(backend).on_device || std::stoi(found.row) <= 1024) return found;
  s.threads = 2;
  if (result_of(s, dir, c.readings) != found.row)
    found.note = "two threads give other bits than one";
  return found;
} catch (const std::exception& e) {
  return {"", e.what(), 0};
}

std::vector<Found> run_all(const std::vector<Case>& cases, Backend backend, int jobs, bool times) {
  std::vector<Found> found(2 * cases.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k; (k = next++) < found.size();) {
      const Stopwatch watch;
      found[k] = run_case(cases[k / 2], k % 2 ? Precision::dbl : Precision::single, backend);
      found[k].seconds = watch.seconds();
      if (times) std::fprintf(stderr, "%6.2f s  %s\n", found[k].seconds, cases[k / 2].name.c_str());
    }
  };
  std::vector<std::thread> others;
  for (int j = 1; j < jobs; ++j) others.emplace_back(work);
  work();
  for (std::thread& t : others) t.join();
  return found;
}

int main_of(const std::vector<std::string>& names, bool write, Backend backend, bool times) {
  const std::vector<Case> cases = read_cases(names);
  const Stopwatch watch;
  const auto found =
      run_all(cases, backend, about(backend).on_device ? 1 : usable_threads(), times);
  const Table frozen = read_table();
  std::string text = std::string(kHead) + "\n";
  std::size_t wrong = 0, rows = 0;
  const auto say = [&](const std::string& key, const std::string& what) {
    std::printf("%s: %s\n", key.c_str(), what.c_str());
    ++wrong;
  };
  Table left = frozen;
  for (std::size_t k = 0; k < found.size(); ++k, ++rows) {
    const std::string key = key_of(cases[k / 2], k % 2 ? Precision::dbl : Precision::single);
    text += key + "," + found[k].row + "\n";
    left.erase(key);
    if (!found[k].note.empty()) say(key, found[k].note);
    if (write || found[k].row.empty()) continue;
    const auto was = frozen.find(key);
    if (was == frozen.end())
      say(key, "is not in " + kHashes.filename().string());
    else if (was->second != found[k].row)
      say(key, "was " + was->second + ", is " + found[k].row);
  }
  if (!write && names.empty())
    for (const auto& [key, row] : left) say(key, "is no case of cases.txt");
  const auto slowest =
      std::max_element(found.begin(), found.end(),
                       [](const Found& a, const Found& b) { return a.seconds < b.seconds; });
  std::printf("%zu rows in %.1f s, %zu wrong; the slowest took %.1f s: %s\n", rows, watch.seconds(),
              wrong, slowest->seconds,
              cases[std::size_t(slowest - found.begin()) / 2].name.c_str());
  if (write && wrong == 0) {
    std::ofstream(kHashes) << text;
    std::printf("%s is written anew\n", kHashes.c_str());
  } else if (wrong > 0 && !write) {
    std::printf(
        "(particles,updates,position,velocity,readings.) Bits changed. Where that is meant, renew "
        "them:\n"
        "  tests/regression/frozen_hashes BUILD_FOLDER --write\n"
        "and say in the commit which cases changed and why.\n");
  }
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  bool write = false, times = false;
  std::vector<std::string> names;
  Backend backend = Backend::cpu;
  for (int k = 1; k < argc; ++k) {
    if (std::strcmp(argv[k], "--write") == 0 && names.empty()) {
      write = true;
    } else if (std::strcmp(argv[k], "--times") == 0) {
      times = true;
    } else if (std::strcmp(argv[k], "--on") == 0 && k + 1 < argc && named<Backend>(argv[k + 1])) {
      backend = *named<Backend>(argv[++k]);
    } else if (argv[k][0] != '-' && !write) {
      names.push_back(argv[k]);
    } else {
      std::printf(
          "Runs the cases of tests/regression/frozen/cases.txt and compares with hashes.csv.\n"
          "Usage: frozen [--on BACKEND] [--times] [--write | CASE...]\n"
          "  --on BACKEND  with solver.reproducible: the same hashes; exit 77 without a GPU for "
          "it\n"
          "  --write       write hashes.csv anew, where one and two threads agree\n"
          "  --times       the time of every row, on stderr\n");
      return std::strcmp(argv[k], "--help") == 0 ? 0 : 2;
    }
  }
  if (backend == Backend::cuda) {
    std::string why = "this build has no CUDA backend";
#ifdef PBF_HAS_CUDA
    if (cuda_available(&why)) return main_of(names, write, backend, times);
#endif
    std::printf("skipped: %s\n", why.c_str());
    return 77;
  }
  return main_of(names, write, backend, times);
} catch (const pbf::Error& e) {
  std::printf("frozen: %s\n", e.what());
  return static_cast<int>(e.code());
}
