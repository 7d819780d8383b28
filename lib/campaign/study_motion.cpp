// The errors of motion of a study: differences from its reference over time, and their orders.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "lib/base/error.h"
#include "lib/campaign/study_table.h"
#include "lib/data/units.h"
#include "lib/scene/load.h"

namespace pbf::campaign_module {
namespace {

/// What runs of the same text share: all but the step and what is written how often.
std::string without_step(Scene s) {
  s.name.clear();
  s.time.step = 1;
  s.measure_every = 1;
  s.output.reset();
  s.compare.clear();
  s.summary.clear(), s.summary_from = 0;
  s.render.reset();
  s.checkpoint.reset();
  return resolved_yaml(s);
}

double step_of(const StudyRow& row) { return row.member->scene.time.step; }

/// The order that errors c (dt^p - dt_ref^p) of a method of order p seem to have, because the
/// reference has an error of the same kind.
double seeming_order(double p, double coarse, double fine, double reference) {
  const double r = std::pow(reference, p);
  return std::log((std::pow(coarse, p) - r) / (std::pow(fine, p) - r)) / std::log(coarse / fine);
}

/// The order of the errors of `fine` and of `coarse`, the run with the next longer step.
void find_order(const Study& study, std::size_t error, const StudyRow& coarse, StudyRow& fine) {
  MotionResult& out = fine.motion[error];
  const double e1 = coarse.motion[error].difference->rms, e2 = out.difference->rms;
  const double dt1 = step_of(coarse), dt2 = step_of(fine);
  const Scene& reference = study.reference->scene;
  const bool same_series = without_step(reference) == fine.series;
  if (same_series && !(reference.time.step < dt2)) {
    out.note = "no order: the reference has no shorter step";
  } else if (!(e2 > 0)) {
    out.note = "no order: no difference";
  } else if (!(e2 < e1)) {
    out.note = "no order: not less than with the longer step";
  } else {
    out.order = std::log(e1 / e2) / std::log(dt1 / dt2);
    if (same_series)
      out.note = fmt::format("order 1 would show as {:.2f}, 2 as {:.2f}",
                             seeming_order(1, dt1, dt2, reference.time.step),
                             seeming_order(2, dt1, dt2, reference.time.step));
  }
}

}  // namespace

std::string MotionError::rms() const { return column + "_rms" + unit_ending(unit); }
std::string MotionError::relative() const { return column + "_rms_relative"; }
std::string MotionError::order() const { return column + "_order"; }

void check_reference(const Study& study, const MemberResult& r) {
  const StudyMember& m = *study.reference;
  const std::string name = m.label == "reference" ? "this run" : m.label;
  const std::string remedy = "; nothing can be compared with it: name another run";
  if (r.status != "finished")
    bad_input(study.reference_key, name + " " + r.status + " " + r.message + remedy);
  if (const double rise = r.series("energy_rise").back(); !(rise <= m.energy_limit))
    bad_input(study.reference_key,
              fmt::format("the energy of {} rose by {:.3g} % of its start, the limit is {:.3g} %{} "
                          "or a larger energy_limit",
                          name, 100 * rise, 100 * m.energy_limit, remedy));
}

void compare_motion(const Study& study, const MemberResult* reference, StudyRow& row) {
  row.is_reference = study.reference && row.member->scene == study.reference->scene;
  row.motion.assign(study.motion.size(), {});
  if (study.motion.empty()) return;
  row.series = without_step(row.member->scene);
  for (std::size_t k = 0; k < study.motion.size(); ++k) {
    MotionResult& out = row.motion[k];
    const std::string& column = study.motion[k].column;
    if (row.status != "finished" || !reference) {
      out.note = row.status;
      continue;
    }
    try {
      out.difference = compare_series({row.result.series("time"), row.result.series(column)},
                                      {reference->series("time"), reference->series(column)},
                                      {.from = study.from});
    } catch (const Error& e) {
      if (e.code() != ExitCode::bad_input) throw;
      out.note = e.what();
      row.message += (row.message.empty() ? "" : "; ") + column + ": " + out.note;
      continue;
    }
    if (!out.difference->rms_relative) out.note = "the reference never changes";
  }
}

void find_orders(const Study& study, std::vector<StudyRow>& rows) {
  std::map<std::string, std::vector<StudyRow*>> all_series;
  for (StudyRow& row : rows)
    if (row.status == "finished")
      all_series[row.series].push_back(&row);
    else
      for (MotionResult& out : row.motion) out.note = row.status;
  for (std::size_t error = 0; error < study.motion.size(); ++error)
    for (auto& [text, series] : all_series) {
      std::ranges::stable_sort(series, std::greater(), [](StudyRow* r) { return step_of(*r); });
      const StudyRow* coarser = nullptr;  // the last one with a longer step
      for (auto at = series.begin(); at != series.end();) {
        const auto next = std::find_if(at, series.end(),
                                       [&](StudyRow* r) { return step_of(*r) < step_of(**at); });
        const StudyRow* last = nullptr;
        for (auto row = at; row != next; ++row) {
          MotionResult& out = (*row)->motion[error];
          if (!out.difference) continue;
          if ((*row)->is_reference)
            out.note = "the reference";
          else if (next - at > 1)
            out.note = "no order: two runs have this time.step";
          else if (!coarser)
            out.note = "no order: no run with a longer step";
          else
            find_order(study, error, *coarser, **row);
          last = *row;
        }
        if (last && !last->is_reference) coarser = last;
        at = next;
      }
    }
}

Table motion_table(const std::vector<StudyRow>& rows, std::size_t error) {
  using R = const StudyRow&;
  using D = const SeriesDifference&;
  const auto of = [error](auto number) {
    return [error, number](R r) -> Cell {
      const auto& d = r.motion[error].difference;
      return d ? number(*d) : Cell();
    };
  };
  return TableOf<StudyRow>(
      {{"setting", [](R r) { return setting_of(r); }},
       {"seconds_median", [](R r) { return known(r.result.seconds_median()); }},
       {"rms", of([](D d) { return Cell(d.rms); })},
       {"rms_relative", of([](D d) { return known(d.rms_relative.value_or(NAN)); })},
       {"bias", of([](D d) { return Cell(d.bias); })},
       {"correlation", of([](D d) { return known(d.correlation.value_or(NAN)); })},
       {"range", of([](D d) { return Cell(d.range); })},
       {"points", of([](D d) { return Cell(std::int64_t(d.points)); })},
       {"interpolated", of([](D d) { return Cell(std::int64_t(d.interpolated)); })},
       {"order", [error](R r) { return known(r.motion[error].order.value_or(NAN)); }},
       {"note", [error](R r) { return r.motion[error].note; }}},
      rows);
}

}  // namespace pbf::campaign_module
