// The results of a study as a table: measures over the window, Pareto front, cheapest settings.
#pragma once

#include <string>
#include <vector>

#include "lib/campaign/study_member.h"
#include "lib/io/table.h"

namespace pbf::inline campaign_module {

/// What a result counts as. Only finished rows are on the front or a cheapest setting.
///   finished     ran to its end, energy_rise within the limit
///   energy_rose  ran to its end, but made more energy than energy_limit: its errors are no verdict
///   diverged     stopped by the guard
///   unavailable  backend, device or memory not there
struct StudyRow {
  const StudyMember* member = nullptr;
  std::string status, message;
  MemberResult result;            ///< `seconds`: NaN where it never ran
  std::vector<double> measures;   ///< by study_error_measures(); NaN: not defined
  std::vector<FrontCurve> front;  ///< one, or none
  bool pareto = false;
};

/// The row of a result. `reference`: that of Study::reference, null without.
StudyRow study_row(const Study& study, const StudyMember& member, const MemberResult& result,
                   const MemberResult* reference);

double measure_of(const Study& study, const StudyRow& row, const std::string& name);

/// Marks the rows that no other one beats in both seconds_median and error.
void mark_front(const Study& study, std::vector<StudyRow>& rows);

/// Rows, and for every moment of the fronts, as tables (CSV and JSON).
Table study_table(const Study& study, const std::vector<StudyRow>& rows);
Table front_table(const Study& study, const std::vector<StudyRow>& rows);

/// The setting with the smallest seconds_median of those with an error of at most `target`, by
/// variant ("" : of all). Null when there is none.
const StudyRow* cheapest(const Study& study, const std::vector<StudyRow>& rows, double target,
                         const std::string& variant);

/// The table for a terminal, * marking the Pareto front, with the cheapest settings below.
std::string study_text(const Study& study, const std::vector<StudyRow>& rows);

/// Everything as one JSON object.
std::string study_json(const Study& study, const std::vector<StudyRow>& rows);

}  // namespace pbf::inline campaign_module
