// A comparison as text, JSON and one HTML page.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lib/base/text.h"
#include "lib/io/junit.h"
#include "lib/io/table.h"
#include "lib/verify/compare.h"

namespace pbf::inline verify_module {
namespace {

TableOf<CompareRow> table_of(const std::vector<CompareRow>& rows) {
  using R = const CompareRow&;
  return TableOf<CompareRow>({{"", [](R r) { return r.what; }, -34},
                              {"error", [](R r) { return r.error; }, 10, "%.3g"},
                              {"rms", [](R r) { return r.rms; }, 10, "%.3g"},
                              {"relative", [](R r) { return r.relative; }, 9, "%.2g"},
                              {"ulps", [](R r) { return r.ulps; }, 9, "%.3g"},
                              {"tolerance", [](R r) { return r.tolerance; }, 10, "%.3g"},
                              {"unit", [](R r) { return r.unit; }, -11},
                              {"verdict", [](R r) { return verdict_name(r.verdict); }, -7}},
                             rows);
}

std::string escaped(const std::string& s) {
  std::string out;
  for (const char c : s)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string conclusion(const CompareResult& r) {
  if (r.same()) return "same: every difference is within its tolerance";
  std::string s = "DIFFERENT";
  if (!r.stage.empty()) s += ", first in stage `" + r.stage + "`";
  return s;
}

const char* const kColors[] = {"#2563eb", "#93b4f5", "#d97706", "#16a34a"};

/// Where the points of a diagram go, in pixels, y downwards: x linear, y logarithmic over whole
/// powers of ten that hold every positive finite point.
struct DiagramScale {
  static constexpr double width = 760, height = 330, left = 60, right = width - 20, top = 44,
                          bottom = height - 40;
  double x1 = 1, log0 = -1, log1 = 0;  ///< end of x, which begins at 0; range of log10(y)
  std::vector<std::pair<double, std::string>> x_ticks, y_ticks;

  explicit DiagramScale(const Diagram& d) {
    double low = HUGE_VAL, high = 0;
    for (const Curve& c : d.curves)
      for (std::size_t k = 0; k < c.x.size(); ++k) {
        x1 = std::max(x1, c.x[k]);
        if (!(c.y[k] > 0) || !std::isfinite(c.y[k])) continue;
        low = std::min(low, c.y[k]);
        high = std::max(high, c.y[k]);
      }
    if (high > 0) {
      log0 = std::floor(std::log10(low));
      log1 = std::max(log0 + 1, std::ceil(std::log10(high)));
    }
    const int every = std::max(1, int((log1 - log0) / 8));
    for (int p = int(log0); p <= int(log1); p += every)
      y_ticks.emplace_back(std::pow(10.0, p), format("1e%d", p));
    const double raw = x1 / 6, power = std::pow(10, std::floor(std::log10(raw)));
    const double step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : 5);
    for (double v = 0; v <= x1 * (1 + 1e-9); v += step) x_ticks.emplace_back(v, format("%g", v));
  }
  double x(double v) const { return left + v / x1 * (right - left); }
  double y(double v) const {
    return bottom - (std::log10(v) - log0) / (log1 - log0) * (bottom - top);
  }
};

std::string svg(const Diagram& d) {
  const DiagramScale s(d);
  std::string out = format("<svg viewBox=\"0 0 %g %g\" width=\"%g\" height=\"%g\">\n", s.width,
                           s.height, s.width, s.height);
  out +=
      format("<text x=\"%g\" y=\"18\" class=\"t\">%s</text>\n", s.left, escaped(d.title).c_str());
  for (const auto& [value, label] : s.y_ticks)
    out += format(
        "<path d=\"M%g %.1fH%g\" class=\"g\"/><text x=\"%g\" y=\"%.1f\" "
        "text-anchor=\"end\">%s</text>\n",
        s.left, s.y(value), s.right, s.left - 6, s.y(value) + 4, label.c_str());
  for (const auto& [value, label] : s.x_ticks)
    out += format("<text x=\"%.1f\" y=\"%g\" text-anchor=\"middle\">%s</text>\n", s.x(value),
                  s.bottom + 16, label.c_str());
  out += format(
      "<text x=\"%g\" y=\"%g\" text-anchor=\"end\">%s</text><text x=\"%g\" y=\"34\">%s"
      "</text>\n",
      s.right, s.bottom + 32, escaped(d.x_label).c_str(), s.left, escaped(d.y_label).c_str());
  for (std::size_t c = 0; c < d.curves.size(); ++c) {
    const char* color = kColors[c % std::size(kColors)];
    std::string points;
    for (std::size_t k = 0; k < d.curves[c].x.size(); ++k)
      if (d.curves[c].y[k] > 0 && std::isfinite(d.curves[c].y[k]))
        points += format("%.1f,%.1f ", s.x(d.curves[c].x[k]), s.y(d.curves[c].y[k]));
    out += format(
        "<polyline points=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"/>"
        "<text x=\"%g\" y=\"%g\" fill=\"%s\">%s</text>\n",
        points.c_str(), color, s.right - 160, s.bottom - 12 - 16.0 * double(c), color,
        escaped(d.curves[c].name).c_str());
  }
  return out + "</svg>\n";
}

}  // namespace

std::string compare_text(const CompareResult& r) {
  std::string out = "A  " + r.a + "\nB  " + r.b + "\n";
  for (const std::string& n : r.notes) out += "   " + n + "\n";
  for (const ComparePart& p : r.parts) {
    out += "\n" + p.name + ": " + verdict_name(p.verdict) + "\n  " + p.finding +
           "\n  tolerance: " + p.tolerance_source + "\n";
    if (!p.rows.empty()) out += table_of(p.rows).text("  ");
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
      row.details = format("error %.6g, rms %.3g, relative %.3g, ulps %.3g, tolerance %.6g",
                           x.error, x.rms, x.relative, x.ulps, x.tolerance);
      if (x.verdict == Verdict::differs)
        row.failure = format("differs by %.6g, tolerance %.6g", x.error, x.tolerance) +
                      (x.unit.empty() ? "" : format(" (%s)", x.unit.c_str()));
    }
  }
  return junit_xml(suite);
}

std::string compare_json(const CompareResult& r) {
  Json parts = Json::array(), curves = Json::array();
  for (const ComparePart& p : r.parts) {
    Json rows = Json::array();
    for (const CompareRow& x : p.rows)
      rows.push_back({{"what", x.what},
                      {"unit", x.unit},
                      {"error", x.error},
                      {"rms", x.rms},
                      {"relative", x.relative},
                      {"ulps", x.ulps},
                      {"tolerance", x.tolerance},
                      {"verdict", verdict_name(x.verdict)}});
    parts.push_back({{"part", p.name},
                     {"verdict", verdict_name(p.verdict)},
                     {"finding", p.finding},
                     {"tolerance_source", p.tolerance_source},
                     {"rows", rows}});
  }
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

std::string compare_html(const CompareResult& r) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>pbf compare</title>\n"
      "<style>body{font:15px system-ui,sans-serif;max-width:960px;margin:2em auto;color:#1f2937}"
      "table{border-collapse:collapse;font-size:13px;margin:.6em 0}td,th{padding:2px 9px;"
      "border-bottom:1px solid #e5e7eb;text-align:right}td:first-child,th:first-child,"
      "td:last-child{text-align:left}.bad{background:#fee2e2}.s{color:#6b7280}"
      "svg text{font-size:12px;fill:currentColor}svg .t{font-weight:600;font-size:14px}"
      "svg .g{stroke:#e5e7eb}</style>\n";
  out += format("<h1>%s</h1>\n<p>A: %s<br>B: %s</p>\n", escaped(conclusion(r)).c_str(),
                escaped(r.a).c_str(), escaped(r.b).c_str());
  for (const std::string& n : r.notes) out += "<p class=s>" + escaped(n) + "</p>\n";
  for (const Diagram& d : r.diagrams) out += svg(d);
  for (const ComparePart& p : r.parts) {
    out += format("<h2>%s: %s</h2>\n<p>%s</p><p class=s>Tolerance: %s.</p>\n",
                  escaped(p.name).c_str(), verdict_name(p.verdict), escaped(p.finding).c_str(),
                  escaped(p.tolerance_source).c_str());
    if (p.rows.empty()) continue;
    out += "<table><tr><th><th>error<th>rms<th>relative<th>ulps<th>tolerance<th>unit<th>verdict\n";
    const auto rows = table_of(p.rows).words();
    for (std::size_t k = 0; k < rows.size(); ++k) {
      out += p.rows[k].verdict == Verdict::differs ? "<tr class=bad>" : "<tr>";
      for (const std::string& word : rows[k]) out += "<td>" + escaped(word);
      out += "\n";
    }
    out += "</table>\n";
  }
  return out + "</html>\n";
}

}  // namespace pbf::inline verify_module
