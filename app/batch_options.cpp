#include "app/batch_options.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "app/batch_slurm.h"
#include "lib/base/machine.h"

namespace pbf::app_module {
namespace {

namespace fs = std::filesystem;

/// The command on one line, with absolute paths, for a script that runs elsewhere.
std::string command_text(const BatchOptions& o, const std::string& out) {
  std::string text = shell_quoted(fs::read_symlink("/proc/self/exe").string()) + " batch " +
                     shell_quoted(fs::absolute(o.input).string()) + " --out " +
                     shell_quoted(fs::absolute(out).string());
  for (const std::string& g : o.grid) text += " --grid " + shell_quoted(g);
  for (const std::string& word : options_of_runs(o)) text += " " + shell_quoted(word);
  return text;
}

}  // namespace

std::vector<std::string> options_of_runs(const BatchOptions& o) {
  std::vector<std::string> words;
  for (const std::string& s : o.overrides) words.insert(words.end(), {"--set", s});
  if (!o.base_folder.empty())
    words.insert(words.end(), {"--base-folder", fs::absolute(o.base_folder).string()});
  if (o.strict) words.push_back("--strict");
  return words;
}

JobLimits limits(const BatchOptions& o) {
  JobLimits limits;
  if (o.jobs > 0) {
    limits.alone = limits.shared = o.jobs;
    limits.particles = std::numeric_limits<std::int64_t>::max();
  }
  return limits;
}

int threads_of_run(const BatchOptions& o, std::int64_t sharing) {
  const int jobs =
      sharing > 0 ? int(std::min<std::int64_t>(limits(o).shared, sharing)) : limits(o).alone;
  return o.threads == 0 && jobs > 1 ? std::max(1, usable_threads() / jobs) : o.threads;
}

std::string slurm_text(const BatchOptions& o, const std::string& out,
                       const std::vector<BatchMember>& members) {
  SlurmWishes wishes;
  wishes.command = command_text(o, out);
  wishes.runs = members.size();
  if (o.threads > 0) wishes.threads = o.threads;
  wishes.ranks = o.ranks;
  wishes.time = o.time;
  slurm_seconds(o.time);  // reports errors before the runs are checked
  std::vector<std::string> overrides = o.overrides;
  overrides.push_back("threads=" + std::to_string(wishes.threads));
  for (const JobNeeds& n : check_members(members, overrides, o.base_folder, false, o.ranks)) {
    wishes.needs.host_bytes = std::max(wishes.needs.host_bytes, n.host_bytes);
    wishes.needs.device |= n.device;
  }
  return slurm_script(wishes);
}

}  // namespace pbf::app_module
