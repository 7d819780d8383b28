#include "lib/campaign/study_table.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/scene/number.h"
#include "lib/scene/vector3.h"
#include "lib/solver/diagnostics.h"

namespace pbf::campaign_module {
namespace {

/// The diagnostics that a study averages.
std::vector<Diagnostic> study_diagnostics() {
  std::vector<Diagnostic> all(diagnostics().begin(), diagnostics().end());
  std::erase_if(all, [](const Diagnostic& d) { return d.over == Over::none; });
  return all;
}

double over_window(const MemberResult& r, const Diagnostic& m, double from) {
  const auto &time = r.series("time"), &values = r.series(m.name);
  double sum = 0, largest = -std::numeric_limits<double>::infinity();
  std::size_t n = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (time[k] < from) continue;
    sum += m.over == Over::rms ? values[k] * values[k] : values[k];
    largest = std::max(largest, values[k]);
    ++n;
  }
  if (n == 0) return NAN;  // the run ended before the window
  if (m.over == Over::mean) return sum / double(n);
  if (m.over == Over::rms) return std::sqrt(sum / double(n));
  if (m.over == Over::max) return std::isnan(sum) ? NAN : largest;
  return values.back();
}

/// RMS over time of the distance between the centers of mass, in units of `length` (m).
double reference_distance(const MemberResult& r, const MemberResult& reference, double length) {
  double squares = 0;
  const auto &time = r.series("time"), &there = reference.series("time");
  for (const char* name : {"center_of_mass_x", "center_of_mass_y", "center_of_mass_z"})
    for (std::size_t k = 0; k < time.size(); ++k) {
      const double e = r.series(name)[k] - value_at({there, reference.series(name)}, time[k]);
      squares += e * e;
    }
  return std::sqrt(squares / double(time.size())) / length;
}

std::size_t index_of(const Study& study, const std::string& name) {
  const auto names = study_error_measures(study);
  return std::size_t(std::ranges::find(names, name) - names.begin());
}

/// A value as written in the study file; a number if it is one.
Cell cell_of(const std::string& text) {
  double v = 0;
  std::int64_t i = 0;
  if (read_number(text, i) == NumberError::none) return i;
  if (read_number(text, v) == NumberError::none) return v;
  return text;
}

/// Keys that always have their own column.
bool has_own_column(const std::string& key) {
  return key == "backend" || key == "precision" || key == "threads";
}

std::vector<Column<StudyRow>> setting_columns(const Study& study) {
  using R = const StudyRow&;
  std::vector<Column<StudyRow>> columns;
  if (study.has_variants) columns.push_back({"variant", [](R r) { return r.member->variant; }});
  for (std::size_t k = 0; k < study.keys.size(); ++k)
    if (!has_own_column(study.keys[k]))
      columns.push_back({study.keys[k], [k](R r) { return cell_of(r.member->values[k]); }});
  columns.push_back({"backend", [](R r) { return r.result.backend; }});
  columns.push_back({"precision", [](R r) { return r.result.precision; }});
  columns.push_back({"threads", [](R r) { return r.result.threads; }});
  columns.push_back({"particles", [](R r) { return r.result.particles; }});
  return columns;
}

bool counts(const Study& study, const StudyRow& row, const std::string& measure) {
  const bool of_reference = measure == "reference_distance" ||
                            std::ranges::any_of(study.motion, [&](const MotionError& e) {
                              return measure == e.rms() || measure == e.relative();
                            });
  return row.status == "finished" && std::isfinite(measure_of(study, row, measure)) &&
         !(row.is_reference && of_reference);
}

}  // namespace

std::vector<std::string> study_error_measures(const Study& study) {
  std::vector<std::string> names;
  for (const Diagnostic& m : study_diagnostics()) names.push_back(m.name);
  names.push_back("height_error");
  if (study.reference) names.push_back("reference_distance");
  if (study.front)
    for (const FrontData& d : study.front->data) names.push_back("front_rms_" + d.name);
  for (const MotionError& e : study.motion) names.push_back(e.rms()), names.push_back(e.relative());
  for (const std::string& name : comparison_measures(study)) names.push_back(name);
  return names;
}

StudyRow study_row(const Study& study, const StudyMember& member, const MemberResult& result,
                   const MemberResult* reference) {
  StudyRow row;
  row.member = &member;
  row.result = result;
  row.status = result.status;
  row.message = result.message;
  compare_motion(study, reference, row);
  const auto names = study_error_measures(study);
  if (result.log.empty()) {  // it never ran
    row.measures.assign(names.size(), NAN);
    row.result.seconds = NAN;
    return row;
  }
  for (const Diagnostic& m : study_diagnostics())
    row.measures.push_back(over_window(result, m, study.from));
  row.measures.push_back(std::fabs(1 - row.measures[index_of(study, "height_kept")]));
  const Scene& s = member.scene;
  if (study.reference) {
    // Edge of a cube (in 2-D a square) with the volume of the fluid.
    const double cells =
        double(result.particles) * s.particle_mass() / (s.fluid.rest_density * s.cell_volume());
    const double length = s.fluid.spacing * std::pow(cells, 1.0 / s.dimensions);
    row.measures.push_back(reference ? reference_distance(result, *reference, length) : NAN);
  }
  if (study.front) {
    const std::string column = std::string("front_") + "xyz"[study.front->axis];
    row.front.push_back(front_curve(*study.front, length(s.gravity), s.fluid.spacing,
                                    result.series("time"), result.series(column)));
    for (const FrontData& d : study.front->data)
      row.measures.push_back(front_deviation(row.front[0], d));
  }
  for (const MotionResult& m : row.motion) {
    row.measures.push_back(m.difference ? m.difference->rms : NAN);
    row.measures.push_back(m.difference ? m.difference->rms_relative.value_or(NAN) : NAN);
  }
  std::string note;
  for (const double measure : compare_with_data(study, result, note))
    row.measures.push_back(measure);
  if (!note.empty() && row.status == "finished")
    row.message += (row.message.empty() ? "" : "; ") + note;
  const double rise = measure_of(study, row, "energy_rise");
  if (row.status == "finished" && !(rise <= member.energy_limit)) {
    row.status = "energy_rose";
    row.message = fmt::format("by {:.3g} % of its start, the limit is {:.3g} %", 100 * rise,
                              100 * member.energy_limit);
  }
  return row;
}

double measure_of(const Study& study, const StudyRow& row, const std::string& name) {
  const std::size_t k = index_of(study, name);
  return k < row.measures.size() ? row.measures[k] : NAN;
}

std::vector<bool> pareto_front(const Study& study, const std::vector<StudyRow>& rows,
                               const std::string& measure) {
  std::vector<bool> front;
  for (const StudyRow& row : rows) {
    bool best = counts(study, row, measure);
    const double seconds = row.result.seconds_median(), error = measure_of(study, row, measure);
    for (const StudyRow& other : rows) {
      if (!best || !counts(study, other, measure)) continue;
      const double s = other.result.seconds_median(), e = measure_of(study, other, measure);
      if (s <= seconds && e <= error && (s < seconds || e < error)) best = false;
    }
    front.push_back(best);
  }
  return front;
}

void mark_front(const Study& study, std::vector<StudyRow>& rows) {
  const std::vector<bool> front = pareto_front(study, rows, study.errors[0]);
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].pareto = front[k];
}

Table study_table(const Study& study, const std::vector<StudyRow>& rows) {
  using R = const StudyRow&;
  auto columns = setting_columns(study);
  columns.push_back({"updates", [](R r) { return r.result.updates; }});
  columns.push_back({"seconds_median", [](R r) { return known(r.result.seconds_median()); }});
  columns.push_back({"seconds_spread", [](R r) { return known(r.result.seconds_spread()); }});
  const auto names = study_error_measures(study);
  for (std::size_t k = 0; k < names.size(); ++k)
    columns.push_back({names[k], [k](R r) { return known(r.measures[k]); }});
  for (std::size_t k = 0; k < study.motion.size(); ++k)
    columns.push_back(
        {study.motion[k].order(), [k](R r) { return known(r.motion[k].order.value_or(NAN)); }});
  columns.push_back({"device", [](R r) { return r.result.device; }});
  columns.push_back({"status", [](R r) { return r.status; }});
  columns.push_back({"message", [](R r) { return r.message; }});
  columns.push_back({"error", [&study](R) { return study.errors[0]; }});
  columns.push_back({"pareto", [](R r) { return r.pareto; }});
  return TableOf<StudyRow>(columns, rows);
}

Table front_table(const Study& study, const std::vector<StudyRow>& rows) {
  struct Point {
    const StudyRow& row;
    double T, Z;
  };
  std::vector<Column<Point>> columns;
  for (const auto& c : setting_columns(study))
    columns.push_back({c.name, [value = c.value](const Point& p) { return value(p.row); }});
  columns.push_back({"T", [](const Point& p) { return p.T; }});
  columns.push_back({"Z", [](const Point& p) { return p.Z; }});
  TableOf<Point> table(columns);
  for (const StudyRow& row : rows)
    for (const FrontCurve& curve : row.front)
      for (std::size_t k = 0; k < curve.T.size(); ++k) table.add({row, curve.T[k], curve.Z[k]});
  return table;
}

const StudyRow* cheapest(const Study& study, const std::vector<StudyRow>& rows,
                         const std::string& measure, double target, const std::string& variant) {
  const StudyRow* best = nullptr;
  for (const StudyRow& row : rows) {
    if (!variant.empty() && row.member->variant != variant) continue;
    if (!counts(study, row, measure) || !(measure_of(study, row, measure) <= target)) continue;
    if (!best || row.result.seconds_median() < best->result.seconds_median()) best = &row;
  }
  return best;
}

}  // namespace pbf::campaign_module
