#include "lib/campaign/batch_list.h"

#include <fmt/core.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/plain_text.h"
#include "lib/exec/ranks/ranked_solver.h"
#include "lib/io/run_file.h"
#include "lib/io/run_path.h"
#include "lib/program/rank_plan.h"
#include "lib/run/load_run.h"
#include "lib/run/start.h"
#include "lib/scene/file_kind.h"
#include "lib/scene/scene_name.h"

namespace pbf::campaign_module {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRuns = 100000, kMostTold = 10;

std::vector<BatchMember> of_folder(const std::string& path) {
  std::vector<BatchMember> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path, error))
    if (has_scene_name(entry.path().string())) all.push_back({"", entry.path().string(), {}});
  if (error) bad_input(path, "cannot be read: " + error.message());
  if (all.size() == 1 && fs::path(all[0].scene).filename() == kResolvedScene) {
    const std::string file = (fs::path(path) / kRunFile).string();
    bad_input(path, "is the folder of a run, expected one of scenes; pbf run " + path +
                        " --resume goes on with the run, and pbf batch " +
                        (fs::exists(file, error) ? file : all[0].scene) +
                        " --grid KEY=V1,V2 runs its scene with other settings");
  }
  if (all.empty()) bad_input(path, "holds no scene (*.yaml)");
  std::ranges::sort(all, {}, &BatchMember::scene);
  return all;
}

std::vector<BatchMember> of_list(const std::string& path) {
  note_input(path);
  std::ifstream in(path);
  if (!in) bad_input(path, std::string("cannot be opened: ") + std::strerror(errno));
  std::vector<BatchMember> all;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    const std::string where = path + ":" + std::to_string(number);
    if (const auto found = find_bad_text(line))
      bad_input(where, found->what + "; " + found->remedy);
    BatchMember m;
    for (std::string word; words >> word;) {
      if (m.scene.empty()) {
        m.scene = (fs::path(path).parent_path() / word).string();
      } else {
        if (word.find('=') == std::string::npos)
          bad_input(where,
                    "\"" + word + "\" is not key.path=value; a line is a scene and such settings");
        m.overrides.push_back(word);
      }
    }
    if (m.scene.empty()) continue;
    std::error_code error;
    if (fs::is_directory(m.scene, error)) {
      try {
        run_path(m.scene);
      } catch (const Error& e) {
        bad_input(where, e.what());
      }
    } else if (!has_scene_name(m.scene) && !has_run_name(m.scene)) {
      bad_input(where, m.scene + " is no scene (*.yaml) and no run (*.vtkhdf, or its folder)");
    }
    all.push_back(m);
    if (all.size() > kMostRuns) bad_input(path, "has more than 100000 lines");
  }
  if (all.empty()) bad_input(path, "names no scene");
  return all;
}

void name_all(std::vector<BatchMember>& all) {
  std::set<std::string> taken;
  std::map<std::string, int> next;  // first suffix to try for a name, to avoid a quadratic search
  for (BatchMember& m : all) {
    std::string name = batch_stem(m.scene);
    for (const std::string& o : m.overrides) {
      const std::size_t equals = o.find('=');
      const std::size_t dot = o.rfind('.', equals);
      name += '_';
      name += o.substr(dot == std::string::npos ? 0 : dot + 1);
    }
    name = plain_name(name);
    if (name.empty() || name[0] == '.') name.insert(0, "run");
    m.name = name;
    for (int& k = next.try_emplace(name, 2).first->second; !taken.insert(m.name).second; ++k)
      m.name = name + "_" + std::to_string(k);
  }
}

JobNeeds needs_of(const BatchMember& m, std::vector<std::string> overrides,
                  const std::string& base_folder, bool here, int ranks) {
  overrides.insert(overrides.end(), m.overrides.begin(), m.overrides.end());
  const Start start = prepare(load_scene_or_run(m.scene, overrides, base_folder),
                              {.fits = here, .particles = false, .measured = true});
  JobNeeds needs;
  needs.device = about(start.scene().backend).on_device;
  needs.pictures = start.scene().render.has_value();
  needs.particles = start.plan.most_particles();
  needs.host_bytes = start.plan.memory.host_peak();
  needs.device_bytes = start.plan.memory.device_arrays;
  if (ranks > 1) {
    require_ranks(start.scene(), start.plan, ranks);
    needs.host_bytes = plan_ranks(start.plan, start.scene(), ranks).first_bytes;
  }
  return needs;
}

}  // namespace

std::string batch_stem(const std::string& input) {
  std::error_code error;
  fs::path path = fs::absolute(input, error).lexically_normal();  // resolves "."
  if (!path.has_filename()) path = path.parent_path();
  if (fs::is_directory(path, error)) return path.filename().string();
  if (path.filename() == kRunFile || path.filename() == kResolvedScene)
    return path.parent_path().filename().string();  // these names are the same in every run folder
  return path.stem().string();
}

GridAxis parse_axis(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    bad_input(
        "--grid " + text,
        "expected KEY=V1,V2,... or KEY=FIRST:LAST:COUNT, e.g. --grid solver.iterations=2,4,8");
  std::vector<std::string> values;
  for (const std::string& v : listed_values(text.substr(equals + 1))) {
    if (v.empty()) bad_input("--grid " + text, "has an empty value");
    for (const std::string& value : range_values("--grid " + text, v)) values.push_back(value);
  }
  return grid_axis(text.substr(0, equals), values);
}

std::vector<BatchMember> batch_members(const std::string& input, std::vector<GridAxis> axes) {
  std::error_code error;
  std::vector<BatchMember> scenes, all;
  if (fs::is_directory(input, error))
    scenes = of_folder(input);
  else if (has_scene_name(input) || has_run_name(input))
    scenes = {{"", input, {}}};
  else
    scenes = of_list(input);
  axes.insert(axes.begin(), GridAxis(scenes.size()));
  for (const GridMember& m : grid_members(axes, kMostRuns, "--grid")) {
    std::vector<std::string>& overrides = all.emplace_back(scenes[m.at[0]]).overrides;
    for (const std::string& text : override_texts(m.settings)) overrides.push_back(text);
  }
  name_all(all);
  return all;
}

std::vector<JobNeeds> check_members(const std::vector<BatchMember>& members,
                                    const std::vector<std::string>& overrides,
                                    const std::string& base_folder, bool here, int ranks) {
  std::vector<JobNeeds> needs;
  std::optional<ExitCode> code;
  std::size_t bad = 0;
  std::string text;
  for (const BatchMember& m : members) try {
      needs.push_back(needs_of(m, overrides, base_folder, here, ranks));
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
