// A study's errors against measurements, as the scene's `compare` asks for.
#include <algorithm>
#include <cmath>

#include "lib/campaign/study_reader.h"
#include "lib/campaign/study_table.h"
#include "lib/program/motion.h"

namespace pbf::campaign_module {
namespace {

/// The column of MemberResult::log of a path below /pbf ("gauges/U", "log/front_x").
std::string log_column(const std::string& path, const ReadingSite& site, int component) {
  if (path.starts_with("log/")) return path.substr(4);
  return "gauge/" + path.substr(path.find('/') + 1) +
         (site.components > 1 ? std::string("/") + "xyz"[component] : "");
}

}  // namespace

void StudyReader::read_data() {
  if (study_.members.empty() || study_.members[0].scene.compare.empty()) return;
  double end = study_.members[0].scene.time.end;  // the shortest run
  for (const StudyMember& m : study_.members) end = std::min(end, m.scene.time.end);
  const Scene& scene = study_.members[0].scene;
  for (const StudyMember& m : study_.members)
    if (m.scene.compare != scene.compare)
      problems_.add(path_, "compare",
                    "differs between the runs; all of them are held to the same data: set it for "
                    "every run, not in a variant");
  study_.comparisons = read_comparisons(
      scene.compare, readings_of(stored_readings(scene), has_work(scene)), end, study_.scene_dir);
}

std::vector<std::string> comparison_measures(const Study& study) {
  std::vector<std::string> names;
  for (const DataComparison& c : study.comparisons)
    for (const char* number : {"rms", "rms_relative"})
      names.push_back("compare/" + name_of(c.entry) + "/" + number);
  if (study.comparisons.size() > 1) names.emplace_back("compare/rms_relative");
  return names;
}

std::vector<double> compare_with_data(const Study& study, const MemberResult& r,
                                      std::string& note) {
  if (study.comparisons.empty()) return {};
  std::vector<double> out;
  double squares = 0;
  const std::vector<StoredComparison> results = compare_all(study.comparisons, [&](const Quantity&
                                                                                       q) {
    return without_start({r.series("time"), r.series(log_column(q.path, q.site, q.component))}, q);
  });
  for (const StoredComparison& c : results) {
    out.push_back(number_of(c, "rms")), out.push_back(number_of(c, "rms_relative"));
    squares += out.back() * out.back();
    if (const std::string why = note_of(c); !why.empty())
      note += (note.empty() ? "compare " : "; compare ") + c.name + ": " + why;
  }
  if (results.size() > 1) out.push_back(std::sqrt(squares / double(results.size())));
  return out;
}

}  // namespace pbf::campaign_module
