// The results of a study as tables: measures over the window, Pareto front, cheapest settings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lib/campaign/study.h"
#include "lib/data/series.h"
#include "lib/io/table.h"

namespace pbf::campaign_module {

/// How a quantity of motion of a run differs from that of the reference.
struct MotionResult {
  std::optional<SeriesDifference> difference;  ///< none: it could not be compared
  /// log(e1/e2)/log(dt1/dt2), e: RMS, 1: the run with the next longer time.step that is the same in
  /// everything else, 2: this run.
  std::optional<double> order;
  std::string note;  ///< why there is no difference, or no order; what the order must be held to
};

/// Status of a result. Only finished rows can be on the front or a cheapest setting.
///   finished     ran to its end, energy_rise within the limit
///   energy_rose  ran to its end, but gained more energy than energy_limit: errors not valid
///   diverged     particles became not finite or left the box
///   unavailable  backend, device or memory is missing
struct StudyRow {
  const StudyMember* member = nullptr;
  std::string status, message;
  MemberResult result;               ///< `seconds`: NaN if it never ran
  std::vector<double> measures;      ///< by study_error_measures(); NaN: not defined
  std::vector<FrontCurve> front;     ///< one, or none
  std::vector<MotionResult> motion;  ///< by Study::motion
  bool is_reference = false;
  std::string series;  ///< rows with the same text differ in time.step alone
  bool pareto = false;
};

/// Throws Error(bad_input) if nothing can be compared with this result of Study::reference: it did
/// not finish, or made energy.
void check_reference(const Study& study, const MemberResult& result);

/// The row of a result. `reference`: result of Study::reference, or null.
StudyRow study_row(const Study& study, const StudyMember& member, const MemberResult& result,
                   const MemberResult* reference);

/// The measures of Study::comparisons: "compare/H2/rms", "compare/H2/rms_relative" ..., and of
/// several "compare/rms_relative", the root of the mean square of all.
std::vector<std::string> comparison_measures(const Study& study);
/// Their values for a result; NaN where something cannot be compared, with the reason in `note`.
std::vector<double> compare_with_data(const Study& study, const MemberResult& result,
                                      std::string& note);

/// Fills motion, is_reference and series of a row with its result; `reference` as for study_row().
void compare_motion(const Study& study, const MemberResult* reference, StudyRow& row);

/// NaN if it is not defined.
double measure_of(const Study& study, const StudyRow& row, const std::string& name);

/// Which rows no other row beats in both seconds_median and a measure. The reference, whose own
/// error is 0 by definition, is not among those of motion.
std::vector<bool> pareto_front(const Study& study, const std::vector<StudyRow>& rows,
                               const std::string& measure);
/// Marks those of the first error.
void mark_front(const Study& study, std::vector<StudyRow>& rows);

/// Finds the orders in time.step of the errors of motion, or says why one cannot be told.
void find_orders(const Study& study, std::vector<StudyRow>& rows);

/// Tables (CSV and JSON) of the rows, and of the fronts at all times.
Table study_table(const Study& study, const std::vector<StudyRow>& rows);
Table front_table(const Study& study, const std::vector<StudyRow>& rows);

/// An error of motion of all rows: RMS, relative RMS, bias, correlation, points, order, note.
Table motion_table(const std::vector<StudyRow>& rows, std::size_t error);

/// "consistent time.step=0.001 on cpu float"
std::string setting_of(const StudyRow& row);

/// The setting with the smallest seconds_median among those with a measure of at most `target`, for
/// one variant ("": all). Null if there is none.
const StudyRow* cheapest(const Study& study, const std::vector<StudyRow>& rows,
                         const std::string& measure, double target, const std::string& variant);

/// The table for a terminal, then one per error of motion; * marks the Pareto front. The cheapest
/// settings follow.
std::string study_text(const Study& study, const std::vector<StudyRow>& rows);

/// Everything as one JSON object.
std::string study_json(const Study& study, const std::vector<StudyRow>& rows);

}  // namespace pbf::campaign_module
