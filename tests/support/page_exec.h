// An executor that sees what passes touch: every array lies on pages of its own, and all of them
// are closed before a pass. The first touch of each opens it, and is written down.
#pragma once

#include <signal.h>
#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "lib/exec/cpu/cpu_exec.h"
#include "lib/solver/granted.h"

namespace pbf {

/// As HostBuffer, on pages of its own. New pages hold 0.
template <class T>
class PageBuffer {
 public:
  PageBuffer() = default;
  PageBuffer(PageBuffer&& o) noexcept { swap(o); }
  PageBuffer& operator=(PageBuffer&& o) noexcept {
    swap(o);
    return *this;
  }
  ~PageBuffer() { free(); }

  void resize(std::size_t n) {
    if (n == size_) return;
    free();
    size_ = n;
    if (n == 0) return;
    const auto page = std::size_t(sysconf(_SC_PAGESIZE));
    mapped_ = (n * sizeof(T) + page - 1) / page * page;
    data_ = static_cast<T*>(
        mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    if (data_ == MAP_FAILED) throw std::bad_alloc();
  }
  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

 private:
  void free() {
    if (mapped_) munmap(data_, mapped_);
    data_ = nullptr;
    size_ = mapped_ = 0;
  }
  void swap(PageBuffer& o) {
    std::swap(data_, o.data_);
    std::swap(size_, o.size_);
    std::swap(mapped_, o.mapped_);
  }
  T* data_ = nullptr;
  std::size_t size_ = 0, mapped_ = 0;
};

/// How a pass has touched an array, in the order of first touches. What is read after it has been
/// written is not seen.
struct Touch {
  bool read = false, written = false;
};
/// By name of pass and of field ("position'": the second array).
using Touches = std::map<std::string, std::map<std::string, Touch>>;

class PageExec : public CpuExec {
 public:
  template <class T>
  using Buffer = PageBuffer<T>;
  explicit PageExec(Touches& touches) : CpuExec(1), touches_(touches) {}

  /// Called around every pass of a program (lib/solver/granted.h).
  template <class Launch>
  void watched(const char* pass, const std::vector<FieldMemory>& arrays, const Launch& launch) {
    State& s = state();
    s = {&touches_[pass], arrays};
    struct sigaction now {
    }, before{};
    now.sa_sigaction = &fault;
    now.sa_flags = SA_SIGINFO;
    sigaction(SIGSEGV, &now, &before);
    for (const FieldMemory& a : arrays) mprotect(a.begin, a.bytes, PROT_NONE);
    const struct Opened {  // also when the launch throws
      const std::vector<FieldMemory>& arrays;
      const struct sigaction& before;
      ~Opened() {
        for (const FieldMemory& a : arrays) mprotect(a.begin, a.bytes, PROT_READ | PROT_WRITE);
        sigaction(SIGSEGV, &before, nullptr);
      }
    } opened{arrays, before};
    launch();
  }

 private:
  struct State {
    std::map<std::string, Touch>* touched = nullptr;
    std::vector<FieldMemory> arrays{};
  };
  static State& state() {
    static State s;
    return s;
  }
  static void fault(int, siginfo_t* info, void* context) {
    constexpr int error_register = 19, of_write = 2;  // REG_ERR, x86-64
    const auto* at = static_cast<const char*>(info->si_addr);
    const auto* machine = static_cast<const ucontext_t*>(context);
    const bool write = machine->uc_mcontext.gregs[error_register] & of_write;
    for (const FieldMemory& a : state().arrays) {
      const auto page = std::size_t(sysconf(_SC_PAGESIZE));
      if (at < a.begin || at >= a.begin + (a.bytes + page - 1) / page * page) continue;
      Touch& t = (*state().touched)[std::string(a.field->name) + (a.second ? "'" : "")];
      (write ? t.written : t.read) = true;
      mprotect(a.begin, a.bytes, write ? PROT_READ | PROT_WRITE : PROT_READ);
      return;
    }
    signal(SIGSEGV, SIG_DFL);  // a fault of another kind: it comes again
  }
  Touches& touches_;
};

}  // namespace pbf
