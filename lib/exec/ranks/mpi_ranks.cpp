#include "lib/exec/ranks/mpi_ranks.h"

#include <dlfcn.h>
#include <fmt/core.h>
#include <unistd.h>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "lib/base/error.h"
#include "lib/base/shipped_file.h"
#include "lib/exec/ranks/pbf_mpi.h"

namespace pbf::exec_module {
namespace {

class Mpi final : public MpiRanks {
 public:
  Mpi(const pbf_mpi& mpi, double deadline) : mpi_(mpi) {
    check(mpi_.start(deadline, &rank_, &size_), "MPI_Init");
  }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int local_rank() const override { return launched_local_rank(); }
  std::string describe() const override {
    char text[256] = "";
    mpi_.describe(text, int(sizeof text));
    return text;
  }

  void exchange(std::span<const Outgoing> out, std::span<const Incoming> in) override {
    std::vector<pbf_mpi_message> to, from;
    for (const Outgoing& o : out) to.push_back({o.to, const_cast<void*>(o.data), o.bytes});
    for (const Incoming& i : in) from.push_back({i.from, i.data, i.bytes});
    count(to);
    check(mpi_.exchange(to.data(), int(to.size()), from.data(), int(from.size())), "exchange");
  }
  std::vector<char> all_gather(const void* mine, std::size_t bytes) override {
    std::vector<char> all(bytes * std::size_t(size_));
    check(mpi_.all_gather(mine, bytes, all.data()), "MPI_Allgather");
    return all;
  }
  void sum(std::span<std::int64_t> values) override {
    check(mpi_.sum(values.data(), values.size()), "MPI_Allreduce");
  }
  void gather(std::vector<char> mine, const TakePart& take) override {
    const std::uint64_t bytes = mine.size();
    const std::vector<char> sizes = all_gather(&bytes, sizeof bytes);
    if (rank_ != 0) {
      const pbf_mpi_message to{0, mine.data(), mine.size()};
      return check(mpi_.exchange(&to, 1, nullptr, 0), "gather");
    }
    take(mine);
    for (int r = 1; r < size_; ++r) {
      std::uint64_t n = 0;
      std::memcpy(&n, sizes.data() + std::size_t(r) * sizeof n, sizeof n);
      mine.resize(n);
      const pbf_mpi_message from{r, mine.data(), mine.size()};
      check(mpi_.exchange(nullptr, 0, &from, 1), "gather");
      take(mine);
    }
  }
  void broadcast(std::vector<char>& bytes) override {
    std::uint64_t n = bytes.size();
    check(mpi_.broadcast(&n, sizeof n, 1), "MPI_Ibcast");
    bytes.resize(n);
    check(mpi_.broadcast(bytes.data(), n, 0), "MPI_Ibcast");
  }
  void wait_until(const std::function<bool()>& done) override {
    struct Asked {
      const std::function<bool()>& done;
      std::exception_ptr thrown;
    } asked{done, nullptr};
    const auto ask = [](void* of) -> int {  // nothing may be thrown through the module
      Asked& a = *static_cast<Asked*>(of);
      try {
        return a.done();
      } catch (...) {
        a.thrown = std::current_exception();
        return 1;
      }
    };
    check(mpi_.wait_until(ask, &asked), "MPI_Iprobe");
    if (asked.thrown) std::rethrow_exception(asked.thrown);
  }
  bool failed() const override { return failed_; }
  void end(int code) override {
    if (failed_) mpi_.abort(code);
    mpi_.finish();
  }

 private:
  void tell_failure(const std::string& why, int code) noexcept override {
    failed_ = true;
    if (rank_ == 0) return;  // tells it and ends the others
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    std::fprintf(stderr, "pbf: error: rank %d on %s: %s\n", rank_, host, why.c_str());
    mpi_.abort(code);
  }
  void count(const std::vector<pbf_mpi_message>& out) {
    sent.messages += std::int64_t(out.size());
    for (const pbf_mpi_message& m : out) sent.bytes += std::int64_t(m.bytes);
  }
  void check(int error, const char* call) const {
    if (error == PBF_MPI_SILENT) throw Error(ExitCode::unavailable, mpi_.trouble());
    if (error != 0)
      throw Error(ExitCode::unavailable, fmt::format("{} failed, MPI error {}", call, error));
  }
  const pbf_mpi& mpi_;
  int rank_ = 0, size_ = 1;
  bool failed_ = false;
};

/// A number of the environment; 0: there is none.
int number_of(const char* name) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : 0;
}

/// s after which a rank that waits for others asks whether they live; 0: never.
double deadline() {
  const char* text = std::getenv("PBF_RANK_DEADLINE");
  if (!text) return 300;
  char* end = nullptr;
  const double seconds = std::strtod(text, &end);
  if (end == text || *end != 0 || !(seconds >= 0 && seconds < 1e9))
    throw Error(ExitCode::bad_input,
                fmt::format("the environment variable PBF_RANK_DEADLINE is \"{}\", expected "
                            "seconds, or 0 for no end",
                            text));
  return seconds;
}

}  // namespace

int launched_ranks() {
  int ranks = std::max(number_of("OMPI_COMM_WORLD_SIZE"), number_of("PMI_SIZE"));
  if (std::getenv("PMIX_RANK")) ranks = std::max(ranks, number_of("SLURM_STEP_NUM_TASKS"));
  return std::max(ranks, 1);
}

int launched_rank() {
  return std::max(
      {number_of("OMPI_COMM_WORLD_RANK"), number_of("PMI_RANK"), number_of("PMIX_RANK")});
}

int launched_local_rank() {
  return std::max({number_of("OMPI_COMM_WORLD_LOCAL_RANK"), number_of("MPI_LOCALRANKID"),
                   std::getenv("PMIX_RANK") ? number_of("SLURM_LOCALID") : 0});
}

std::unique_ptr<MpiRanks> open_mpi_ranks() {
  const char* named = std::getenv("PBF_MPI");
  const std::string path = named ? named : shipped_file("libpbf_mpi.so");
  // MPI opens parts of itself, which look for its names among those of the program.
  void* module = dlopen(path.find('/') == std::string::npos ? ("./" + path).c_str() : path.c_str(),
                        RTLD_NOW | RTLD_GLOBAL);
  const auto table =
      module ? reinterpret_cast<const pbf_mpi* (*)()>(dlsym(module, "pbf_mpi_table")) : nullptr;
  if (!table || table()->table != PBF_MPI_TABLE)
    throw Error(ExitCode::unavailable,
                fmt::format("started on {} ranks, but the module for MPI does not fit: {}; make it "
                            "with the compiler of your MPI: mpicc -O2 -shared -fPIC -o "
                            "libpbf_mpi.so {}, and put it beside pbf or name it in PBF_MPI",
                            launched_ranks(),
                            module ? path + " is of another version" : std::string(dlerror()),
                            shipped_file("lib/exec/ranks/pbf_mpi.c")));
  return std::make_unique<Mpi>(*table(), deadline());
}

}  // namespace pbf::exec_module
