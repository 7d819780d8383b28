// The command line of pbf; every error ends here, as one message and an exit code.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <new>
#include <sstream>
#include <string_view>
#include <vector>

#include "app/commands.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/plain_text.h"
#include "lib/base/version.h"
#include "lib/exec/ranks/mpi_ranks.h"
#include "lib/exec/ranks/world.h"
#include "lib/run/signals.h"

namespace pbf::app_module {
namespace {

const char* const kExitCodes =
    "Exit codes:\n"
    "  0   done\n"
    "  1   internal error\n"
    "  2   bad command line or scene\n"
    "  3   run stopped by the stability guard\n"
    "  4   backend, device or memory not available\n"
    "  5   file cannot be read or written (disk full)\n"
    "  6   compare found a difference, batch has failed runs, a suite found a failure, a run\n"
    "      with --strict warned\n"
    "  75  stopped early by a signal or the wall-time limit, after saving\n\n"
    "Example: pbf run configs/dam_break.yaml --out out/dam_break";

/// The words to parse. With --help anywhere, only the command and --help: an option before --help
/// would take it as its value.
std::vector<const char*> words_of_line(const std::vector<std::string>& line) {
  std::vector<const char*> words{"pbf"};
  for (const std::string& word : line) words.push_back(word.c_str());
  const auto asks = [](std::string_view word) { return word == "--help" || word == "-h"; };
  if (words.size() > 2 && *words[1] != '-' && std::any_of(words.begin() + 2, words.end(), asks))
    words = {words[0], words[1], "--help"};
  return words;
}

int run_main(const std::vector<std::string>& line) {
  CLI::App app("pbf: Position Based Fluids, from a scene file to HDF5 and pictures.", "pbf");
  app.set_version_flag("--version", "pbf " + build_info().version);
  app.require_subcommand(1);
  app.footer(kExitCodes);
  int code = 0;
  for (const auto add :
       {add_run, add_plan, add_render, add_compare, add_compare_data, add_probe, add_config,
        add_bench, add_study, add_batch, add_stability, add_info, add_serve_batch})
    add(app, code);
  try {
    const std::vector<const char*> words = words_of_line(line);
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) {  // --help, --version; to stdout, where a failed write is detected
      std::ostringstream text;
      app.exit(e, text, text);
      std::fputs(text.str().c_str(), stdout);
      return 0;
    }
    throw Error(ExitCode::bad_input, explain(app, e));
  }
  return code;
}

template <class Work>
Ending ending_of(const Work& work) {
  const auto failed = [](ExitCode code, const std::string& message) {
    return Ending{static_cast<int>(code), message};
  };
  try {
    return {work()};
  } catch (const Error& e) {
    return failed(e.code(), e.what());
  } catch (const std::bad_alloc&) {
    return failed(ExitCode::unavailable,
                  "not enough memory; use fewer particles (a larger fluid.spacing) or a machine "
                  "with more memory (pbf plan says how much a scene needs)");
  } catch (const std::exception& e) {
    return failed(ExitCode::internal, std::string("internal error: ") + e.what());
  }
}

int fail(ExitCode code, const std::string& message) {
  // Messages may quote any text: arguments, file names, the environment, files of others.
  std::fprintf(stderr, "pbf: error: %s\n", escaped(message).c_str());
  return static_cast<int>(code);
}

int guarded(const std::vector<std::string>& line) {
  const Ending end = ending_of([&] {
    const int code = run_main(line);
    finish_stdout();
    return code;
  });
  return end.message.empty() ? end.code : fail(ExitCode(end.code), end.message);
}

/// Started by mpirun or srun on several ranks: rank 0 does what the command says, the others serve
/// its solvers.
int on_ranks(const std::vector<std::string>& words) {
  // The run that a batch starts inherits the rank.
  if (!words.empty() && words[0] == "batch" && std::ranges::find(words, "--only") != words.end())
    return guarded(words);
  if (words.empty() || (words[0] != "run" && words[0] != "bench")) {
    const ExitCode code = ExitCode::bad_input;
    if (launched_rank() != 0) return static_cast<int>(code);
    return fail(
        code,
        "of the commands, only run, bench and batch --only work on several ranks; start the others "
        "without mpirun or srun");
  }
  try {
    open_world();
    if (world()->rank() != 0) {
      ignore_signals();
      return serve_world();
    }
  } catch (const Error& e) {
    // What is wrong for all of them is told once.
    if (e.code() == ExitCode::bad_input && launched_rank() != 0) return static_cast<int>(e.code());
    return fail(e.code(), e.what());
  }
  const int code = guarded(words);
  end_world(code);
  return code;
}

}  // namespace

Ending execute(const std::vector<std::string>& words) {
  return ending_of([&] { return run_main(words); });
}

}  // namespace pbf::app_module

int main(int argc, char** argv) {
  pbf::hold_standard_streams();
  pbf::see_failed_writes();
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  return pbf::launched_ranks() > 1 ? pbf::on_ranks(words) : pbf::guarded(words);
}
