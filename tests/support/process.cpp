#include "tests/support/process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace pbf::test {
namespace fs = std::filesystem;

pid_t child_of(pid_t parent, const std::string& word) {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string stat = read_text(entry.path() / "stat");
    std::istringstream words(stat.substr(stat.rfind(')') + 1));
    char state = 0;
    pid_t of = 0;
    if (words >> state >> of && of == parent && has(read_text(entry.path() / "cmdline"), word))
      return std::stoi(name);
  }
  return 0;
}

Process::Process(const std::vector<std::string>& args, const fs::path& folder,
                 const std::vector<std::string>& environment) {
  std::vector<std::string> words{PBF_BINARY};
  words.insert(words.end(), args.begin(), args.end());
  start(words, folder, environment);
}

Process Process::program(const std::vector<std::string>& words, const fs::path& folder,
                         const std::vector<std::string>& environment) {
  Process p;
  p.start(words, folder, environment);
  return p;
}

void Process::start(const std::vector<std::string>& words, const fs::path& folder,
                    const std::vector<std::string>& environment) {
  out_ = folder / ".stdout", err_ = folder / ".stderr";
  std::vector<char*> argv;
  for (const auto& w : words) argv.push_back(const_cast<char*>(w.c_str()));
  argv.push_back(nullptr);
  const std::string out = out_.string(), err = err_.string(), dir = folder.string();
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ > 0) return;
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  const int o = open(out.c_str(), flags, 0600), e = open(err.c_str(), flags, 0600);
  if (o < 0 || e < 0 || dup2(o, 1) < 0 || dup2(e, 2) < 0 || chdir(dir.c_str()) != 0) _exit(126);
  setenv("CUDA_VISIBLE_DEVICES", "", 1);  // these tests are the same with and without a GPU
  for (const char* name : {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT"}) unsetenv(name);
  for (const auto& pair : environment) putenv(const_cast<char*>(pair.c_str()));
  execv(argv[0], argv.data());
  _exit(127);
}

void Process::send(int signal) const { kill(pid_, signal); }

bool Process::running() const {
  siginfo_t info{};
  return waitid(P_PID, id_t(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0;
}

Outcome Process::wait(double* user_seconds) {
  int status = 0;
  rusage used{};
  while (wait4(pid_, &status, 0, &used) < 0)
    if (errno != EINTR) throw std::runtime_error("wait4 failed");
  Outcome o;
  if (user_seconds)
    *user_seconds = double(used.ru_utime.tv_sec) + 1e-6 * double(used.ru_utime.tv_usec);
  o.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  o.out = read_text(out_);
  o.err = read_text(err_);
  return o;
}

Outcome pbf(const std::vector<std::string>& args, const fs::path& folder,
            const std::vector<std::string>& environment) {
  return Process(args, folder, environment).wait();
}

Outcome shell(const std::string& lines, const fs::path& folder) {
  // Limits on processes do not hold for root, and count all processes of anybody else.
  const std::string stranger = geteuid() == 0
                                   ? "setpriv --reuid=" + std::to_string(200000 + getpid()) +
                                         " --regid=65534 --clear-groups --inh-caps=-all"
                                   : "env";
  return Process::program({"/usr/bin/env", "timeout", "-k", "1", "60", "bash", "-c", lines}, folder,
                          {"PBF=" PBF_BINARY, "STRANGER=" + stranger})
      .wait();
}

Scratch::Scratch() {
  std::string name = (fs::temp_directory_path() / "pbf_cli_XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("mkdtemp failed");
  path_ = name;
}

Scratch::~Scratch() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string Scratch::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return (path_ / name).string();
}

Outcome run_scene(const Scratch& folder, const std::string& out, const Args& more) {
  Args args{"run", "s.yaml", "--out", out, "--threads", "1", "--quiet"};
  args.insert(args.end(), more.begin(), more.end());
  return pbf(args, folder.path());
}

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string tiny_scene(const std::string& more) {
  return "name: tiny\n"
         "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
         "fluid: {spacing: 0.1}\n"
         "bodies:\n"
         "  - {shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.4]}\n"
         "time: {step: 0.005, end: 0.1}\n"
         "output: {every: 0.02}\n" +
         more;
}

}  // namespace pbf::test
