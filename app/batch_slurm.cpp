#include "app/batch_slurm.h"

#include <fmt/core.h>
#include <algorithm>
#include <regex>

#include "lib/base/error.h"

namespace pbf::app_module {
namespace {

constexpr long kLead = 120;  // s before the time limit, for saving

/// Memory to request: the forecast plus a quarter, and that of the batch itself. Which node a rank
/// comes to is not known, so ranks request theirs by CPU, as much as rank 0 each.
std::string memory(const SlurmWishes& w) {
  const long mib = long(1.25 * double(w.needs.host_bytes) / (1024 * 1024)) + 64;
  if (w.ranks == 1) return fmt::format("#SBATCH --mem={}M\n", mib);
  return fmt::format("#SBATCH --ntasks={}\n#SBATCH --mem-per-cpu={}M\n", w.ranks,
                     (mib + w.threads - 1) / w.threads);
}

}  // namespace

long slurm_seconds(const std::string& text) {
  static const std::regex forms(R"((\d{1,5})(:(\d{1,2})(:(\d{1,2}))?)?)"),
      days(R"((\d{1,4})-(\d{1,2})(:(\d{1,2})(:(\d{1,2}))?)?)");
  std::smatch m;
  const auto part = [&m](int k) { return m[k].matched ? std::stol(m[k].str()) : 0; };
  long seconds = 0;
  if (std::regex_match(text, m, days))
    seconds = ((part(1) * 24 + part(2)) * 60 + part(4)) * 60 + part(6);
  else if (std::regex_match(text, m, forms))
    seconds = m[5].matched ? (part(1) * 60 + part(3)) * 60 + part(5) : part(1) * 60 + part(3);
  if (seconds < 60)
    throw Error(ExitCode::bad_input,
                "--time " + text +
                    ": expected a minute or more as Slurm writes it: minutes, M:S, H:M:S, D-H, "
                    "D-H:M or D-H:M:S");
  return seconds;
}

std::string shell_quoted(const std::string& text) {
  const std::string safe =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._=/,+:@%-";
  if (!text.empty() && text.find_first_not_of(safe) == std::string::npos) return text;
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; };
  const bool escaped = std::any_of(text.begin(), text.end(), control);
  std::string out = escaped ? "$'" : "'";
  for (const char c : text) {
    if (control(c))
      out += fmt::format("\\{:03o}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else if (escaped && (c == '\'' || c == '\\'))
      out += std::string("\\") + c;
    else if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + "'";
}

std::string slurm_script(const SlurmWishes& w) {
  const long lead = std::min(kLead, slurm_seconds(w.time) / 2);
  return fmt::format(
             "#!/bin/bash\n"
             "#SBATCH --job-name=pbf\n"
             "#SBATCH --array=0-{}\n"
             "#SBATCH --cpus-per-task={}\n"
             "{}"
             "#SBATCH --time={}\n"
             "{}"
             "#SBATCH --signal=TERM@{}\n"
             "#SBATCH --requeue\n"
             "#SBATCH --open-mode=append\n",
             w.runs - 1, w.threads, memory(w), w.time,
             !w.needs.device ? ""
             : w.ranks > 1   ? "#SBATCH --gpus-per-task=1\n"
                             : "#SBATCH --gres=gpu:1\n",
             lead) +
         "# Add what your cluster needs (--partition, --account), then: bash FILE\n"
         "# It submits the array, and a job that writes the summary when all tasks have ended.\n"
         "# A task whose time is up saves its run and goes back into the queue.\n"
         "if [ \"${1-}\" = collect ]; then\n"
         "  exec " +
         w.command +
         " --collect\n"
         "fi\n"
         "if [ -z \"${SLURM_ARRAY_TASK_ID-}\" ]; then\n"
         "  array=$(sbatch --parsable \"$0\") || exit\n"
         "  echo \"array $array\"\n"
         "  exec sbatch --dependency=afterany:\"${array%%;*}\" --job-name=pbf-collect --array=0 "
         "\\\n"
         "    --cpus-per-task=1 --time=10" +
         (w.ranks > 1 ? " --ntasks=1" : "") +
         (w.needs.device && w.ranks == 1 ? " --gres=none" : "") +
         " \"$0\" collect\n"
         "fi\n"
         "export SRUN_CPUS_PER_TASK=\"${SLURM_CPUS_PER_TASK:-1}\"  # Slurm >= 22.05\n"
         "srun " +
         (w.ranks > 1 ? "--mpi=pmix " : "") + w.command +
         " --only \"$SLURM_ARRAY_TASK_ID\" --threads \"${SLURM_CPUS_PER_TASK:-1}\"\n"
         "code=$?\n"
         "if [ \"$code\" -eq 75 ]; then\n"
         "  scontrol requeue \"${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}\"\n"
         "fi\n"
         "exit \"$code\"\n";
}

}  // namespace pbf::app_module
