#include "lib/campaign/front.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/data/series.h"
#include "lib/io/csv.h"
#include "lib/scene/number.h"

namespace pbf::campaign_module {
FrontData read_front_data(const std::string& path) {
  note_input(path);
  const std::vector<CsvRow> rows = read_csv(path);
  if (rows.size() < 2) bad_input(path, "holds no data");
  FrontData data;
  data.name = std::filesystem::path(path).stem().string();
  const std::vector<std::string>& head = rows[0].cells;
  const auto t = std::size_t(std::ranges::find(head, "T") - head.begin());
  const auto z = std::size_t(std::ranges::find(head, "Z") - head.begin());
  if (t == head.size() || z == head.size())
    bad_input(rows[0].where, "expected a header with the columns T and Z");
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const auto number = [&](std::size_t column) {
      double value = 0;
      const std::string& text = rows[k].cells[column];
      if (const NumberError e = read_number(text, value);
          e != NumberError::none && e != NumberError::too_small)
        bad_input(rows[k].where, "\"" + text + "\" " + describe(e));
      return value;
    };
    const double at = number(t);
    if (!data.T.empty() && at < data.T.back()) bad_input(rows[k].where, "T must not decrease");
    data.T.push_back(at);
    data.Z.push_back(number(z));
  }
  return data;
}

FrontCurve front_curve(const Front& f, double gravity, double spacing,
                       const std::vector<double>& time, const std::vector<double>& x) {
  FrontCurve c;
  for (std::size_t k = 0; k < time.size(); ++k) {
    c.T.push_back(time[k] * std::sqrt(f.factor * gravity / f.length));
    c.Z.push_back((x[k] + 0.5 * spacing - f.origin) / f.length);
  }
  return c;
}

double front_deviation(const FrontCurve& c, const FrontData& data, std::size_t* points) {
  double squares = 0;
  std::size_t n = 0;
  for (std::size_t k = 0; k < data.T.size(); ++k) {
    const double z = value_at({c.T, c.Z}, data.T[k]);
    if (std::isnan(z)) continue;
    squares += (z - data.Z[k]) * (z - data.Z[k]);
    ++n;
  }
  if (points) *points = n;
  return n ? std::sqrt(squares / double(n)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace pbf::campaign_module
