#include "lib/campaign/batch_check.h"

#include <fmt/core.h>
#include <algorithm>
#include <optional>

#include "lib/base/error.h"
#include "lib/run/load_run.h"
#include "lib/run/start.h"

namespace pbf::campaign_module {
namespace {

constexpr std::size_t kMostTold = 10;

void add_needs(const BatchMember& m, std::vector<std::string> overrides,
               const std::string& base_folder, bool here, BatchNeeds& needs) {
  overrides.insert(overrides.end(), m.overrides.begin(), m.overrides.end());
  const Start start = prepare(load_scene_or_run(m.scene, overrides, base_folder),
                              {.fits = here, .particles = false});
  needs.host_bytes = std::max(needs.host_bytes, start.plan.memory.host_peak());
  needs.device |= about(start.scene().backend).on_device;
}

}  // namespace

BatchNeeds check_members(const std::vector<BatchMember>& members,
                         const std::vector<std::string>& overrides, const std::string& base_folder,
                         bool here) {
  BatchNeeds needs;
  std::optional<ExitCode> code;
  std::size_t bad = 0;
  std::string text;
  for (const BatchMember& m : members) try {
      add_needs(m, overrides, base_folder, here, needs);
    } catch (const Error& e) {
      if (!code) code = e.code();
      if (++bad <= kMostTold) text += "\n  " + m.name + ": " + e.what();
    }
  if (!code) return needs;
  if (bad > kMostTold) text += fmt::format("\n  and {} more", bad - kMostTold);
  throw Error(*code, fmt::format("batch: {} of {} runs cannot start, and none was started:{}", bad,
                                 members.size(), text));
}

}  // namespace pbf::campaign_module
