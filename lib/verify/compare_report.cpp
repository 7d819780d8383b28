// A comparison as text, JSON and one HTML page.
#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/io/report.h"
#include "lib/verify/compare.h"
#include "lib/verify/diagram_scale.h"

namespace pbf::inline verify_module {
namespace {

std::string row_text(const CompareRow& r) {
  return format("  %-34s %10.3g %10.3g %9.2g %9.3g %10.3g %-11s %s\n", r.what.c_str(), r.error,
                r.rms, r.relative, r.ulps, r.tolerance, r.unit.c_str(), verdict_name(r.verdict));
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

std::string svg(const Diagram& d) {
  const DiagramScale s = diagram_scale(d, 760, 330);
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
    if (!p.rows.empty())
      out += format("  %-34s %10s %10s %9s %9s %10s %-11s %s\n", "", "error", "rms", "relative",
                    "ulps", "tolerance", "unit", "verdict");
    for (const CompareRow& row : p.rows) out += row_text(row);
  }
  return out + "\n" + conclusion(r);
}

std::string compare_json(const CompareResult& r) {
  std::vector<std::string> notes, parts, diagrams;
  for (const auto& n : r.notes) notes.push_back(json(Cell(n)));
  for (const ComparePart& p : r.parts) {
    std::vector<std::string> rows;
    for (const CompareRow& x : p.rows)
      rows.push_back(JsonObject()
                         .add("what", x.what)
                         .add("unit", x.unit)
                         .add("error", x.error)
                         .add("rms", x.rms)
                         .add("relative", x.relative)
                         .add("ulps", x.ulps)
                         .add("tolerance", x.tolerance)
                         .add("verdict", std::string(verdict_name(x.verdict)))
                         .text());
    parts.push_back(JsonObject()
                        .add("part", p.name)
                        .add("verdict", std::string(verdict_name(p.verdict)))
                        .add("finding", p.finding)
                        .add("tolerance_source", p.tolerance_source)
                        .add_json("rows", json_array(rows))
                        .text());
  }
  for (const Diagram& d : r.diagrams)
    for (const Curve& c : d.curves) {
      std::vector<std::string> x, y;
      for (const double v : c.x) x.push_back(json(Cell(v)));
      for (const double v : c.y) y.push_back(json(Cell(v)));
      diagrams.push_back(JsonObject()
                             .add("diagram", d.title)
                             .add("curve", c.name)
                             .add("x_label", d.x_label)
                             .add("y_label", d.y_label)
                             .add_json("x", json_array(x))
                             .add_json("y", json_array(y))
                             .text());
    }
  return JsonObject()
             .add("a", r.a)
             .add("b", r.b)
             .add("same", r.same())
             .add("stage", r.stage)
             .add("e_folding_updates", r.e_folding > 0 ? Cell(r.e_folding) : Cell())
             .add("horizon_updates", r.horizon >= 0 ? Cell(r.horizon) : Cell())
             .add_json("notes", json_array(notes))
             .add_json("parts", json_array(parts))
             .add_json("curves", json_array(diagrams))
             .text() +
         "\n";
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
    for (const CompareRow& x : p.rows)
      out += format("<tr%s><td>%s<td>%.3g<td>%.3g<td>%.2g<td>%.3g<td>%.3g<td>%s<td>%s\n",
                    x.verdict == Verdict::differs ? " class=bad" : "", escaped(x.what).c_str(),
                    x.error, x.rms, x.relative, x.ulps, x.tolerance, escaped(x.unit).c_str(),
                    verdict_name(x.verdict));
    out += "</table>\n";
  }
  return out + "</html>\n";
}

}  // namespace pbf::inline verify_module
