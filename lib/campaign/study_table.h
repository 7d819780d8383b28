// The results of a study as tables: measures over the window, Pareto front, cheapest settings.
#pragma once

#include <string>
#include <vector>

#include "lib/campaign/study.h"
#include "lib/io/table.h"

namespace pbf::campaign_module {

/// Status of a result. Only finished rows can be on the front or a cheapest setting.
///   finished     ran to its end, energy_rise within the limit
///   energy_rose  ran to its end, but gained more energy than energy_limit: errors not valid
///   diverged     particles became not finite or left the box
///   unavailable  backend, device or memory is missing
struct StudyRow {
  const StudyMember* member = nullptr;
  std::string status, message;
  MemberResult result;            ///< `seconds`: NaN if it never ran
  std::vector<double> measures;   ///< by study_error_measures(); NaN: not defined
  std::vector<FrontCurve> front;  ///< one, or none
  bool pareto = false;
};

/// The row of a result. `reference`: result of Study::reference, or null.
StudyRow study_row(const Study& study, const StudyMember& member, const MemberResult& result,
                   const MemberResult* reference);

double measure_of(const Study& study, const StudyRow& row, const std::string& name);

/// Marks the rows that no other row beats in both seconds_median and error.
void mark_front(const Study& study, std::vector<StudyRow>& rows);

/// Tables (CSV and JSON) of the rows, and of the fronts at all times.
Table study_table(const Study& study, const std::vector<StudyRow>& rows);
Table front_table(const Study& study, const std::vector<StudyRow>& rows);

/// The setting with the smallest seconds_median among those with an error of at most `target`, for
/// one variant ("": all). Null if there is none.
const StudyRow* cheapest(const Study& study, const std::vector<StudyRow>& rows, double target,
                         const std::string& variant);

/// The table for a terminal; * marks the Pareto front. The cheapest settings follow.
std::string study_text(const Study& study, const std::vector<StudyRow>& rows);

/// Everything as one JSON object.
std::string study_json(const Study& study, const std::vector<StudyRow>& rows);

}  // namespace pbf::campaign_module
