// A comparison as text, JSON and JUnit XML.
#include <fmt/core.h>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "lib/io/junit.h"
#include "lib/io/table.h"
#include "lib/verify/compare.h"

namespace pbf::verify_module {
namespace {

/// `first`: name of the first column.
TableOf<CompareRow> table_of(const std::vector<CompareRow>& rows, const char* first) {
  using R = const CompareRow&;
  return TableOf<CompareRow>({{first, [](R r) { return r.what; }, -34},
                              {"error", [](R r) { return r.error; }, 10, "{:.3g}"},
                              {"rms", [](R r) { return r.rms; }, 10, "{:.3g}"},
                              {"relative", [](R r) { return r.relative; }, 9, "{:.2g}"},
                              {"ulps", [](R r) { return r.ulps; }, 9, "{:.3g}"},
                              {"tolerance", [](R r) { return r.tolerance; }, 10, "{:.3g}"},
                              {"unit", [](R r) { return r.unit; }, -11},
                              {"verdict", [](R r) { return verdict_name(r.verdict); }, -7}},
                             rows);
}

std::string conclusion(const CompareResult& r) {
  if (r.same()) return "same: every difference is within its tolerance";
  std::string s = "DIFFERENT";
  if (!r.stage.empty()) s += ", first in stage `" + r.stage + "`";
  return s;
}

}  // namespace

const char* verdict_name(Verdict v) {
  return v == Verdict::same ? "same" : v == Verdict::differs ? "DIFFERS" : "not judged";
}

bool CompareResult::same() const {
  return std::ranges::count(parts, Verdict::differs, &ComparePart::verdict) == 0;
}

std::string compare_text(const CompareResult& r) {
  std::string out = "A  " + r.a + "\nB  " + r.b + "\n";
  for (const std::string& n : r.notes) out += "   " + n + "\n";
  for (const ComparePart& p : r.parts) {
    out += "\n" + p.name + ": " + verdict_name(p.verdict) + "\n  " + p.finding +
           "\n  tolerance: " + p.tolerance_source + "\n";
    if (!p.rows.empty()) out += table_of(p.rows, "").text("  ");
  }
  return out + "\n" + conclusion(r);
}

std::string compare_junit(const CompareResult& r, double seconds) {
  JunitSuite suite{"pbf compare", {{"A", r.a}, {"B", r.b}}, {}, seconds};
  for (const std::string& note : r.notes) suite.properties.emplace_back("note", note);
  for (const ComparePart& p : r.parts) {
    JunitCase& part = suite.cases.emplace_back(JunitCase{"pbf compare", p.name});
    part.skipped = p.verdict == Verdict::not_judged;
    (p.verdict == Verdict::differs ? part.failure : part.details) = p.finding;
    if (p.verdict == Verdict::differs) part.details = "tolerance: " + p.tolerance_source;
    for (const CompareRow& x : p.rows) {
      JunitCase& row = suite.cases.emplace_back(JunitCase{p.name, x.what});
      row.skipped = x.verdict == Verdict::not_judged;
      row.details =
          fmt::format("error {:.6g}, rms {:.3g}, relative {:.3g}, ulps {:.3g}, tolerance {:.6g}",
                      x.error, x.rms, x.relative, x.ulps, x.tolerance);
      if (x.verdict == Verdict::differs)
        row.failure = fmt::format("differs by {:.6g}, tolerance {:.6g}{}", x.error, x.tolerance,
                                  x.unit.empty() ? "" : fmt::format(" ({})", x.unit));
    }
  }
  return junit_xml(suite);
}

std::string compare_json(const CompareResult& r) {
  Json parts = Json::array(), curves = Json::array();
  for (const ComparePart& p : r.parts)
    parts.push_back({{"part", p.name},
                     {"verdict", verdict_name(p.verdict)},
                     {"finding", p.finding},
                     {"tolerance_source", p.tolerance_source},
                     {"rows", table_of(p.rows, "what").json()}});
  for (const Diagram& d : r.diagrams)
    for (const Curve& c : d.curves)
      curves.push_back({{"diagram", d.title},
                        {"curve", c.name},
                        {"x_label", d.x_label},
                        {"y_label", d.y_label},
                        {"x", c.x},
                        {"y", c.y}});
  const Json out{{"a", r.a},
                 {"b", r.b},
                 {"same", r.same()},
                 {"stage", r.stage},
                 {"e_folding_updates", r.e_folding > 0 ? Json(r.e_folding) : Json()},
                 {"horizon_updates", r.horizon >= 0 ? Json(r.horizon) : Json()},
                 {"notes", r.notes},
                 {"parts", parts},
                 {"curves", curves}};
  return json_text(out, 1) + "\n";
}

}  // namespace pbf::verify_module
