#include "lib/diag/front.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/plain_text.h"
#include "lib/scene/number.h"

namespace pbf {
namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out;
  std::stringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) {
    cell.erase(0, cell.find_first_not_of(" \t"));
    cell.erase(cell.find_last_not_of(" \t\r") + 1);
    out.push_back(cell);
  }
  return out;
}

}  // namespace

FrontData read_front_data(const std::string& path) {
  std::error_code ignored;
  note_input(path);
  std::ifstream in(path);
  if (!in || std::filesystem::is_directory(path, ignored))
    throw Error(ExitCode::io,
                path + ": cannot be read: " + (in ? "is a directory" : std::strerror(errno)));
  FrontData data;
  data.name = std::filesystem::path(path).stem().string();
  std::size_t number = 0, t = 0, z = 0, columns = 0;
  const auto fail = [&](const std::string& what) {
    throw Error(ExitCode::bad_input, path + ":" + std::to_string(number) + ": " + what);
  };
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (const auto found = find_bad_text(line)) fail(found->what + "; " + found->remedy);
    const auto row = cells(line);
    if (line.empty() || line[0] == '#' || row.empty()) continue;
    if (columns == 0) {
      columns = row.size();
      t = std::size_t(std::find(row.begin(), row.end(), "T") - row.begin());
      z = std::size_t(std::find(row.begin(), row.end(), "Z") - row.begin());
      if (t == columns || z == columns) fail("expected a header with the columns T and Z");
      continue;
    }
    if (row.size() != columns)
      fail("has " + std::to_string(row.size()) + " values, the header names " +
           std::to_string(columns));
    double values[2];
    for (const std::size_t k : {0u, 1u}) {
      const std::string& text = row[k == 0 ? t : z];
      if (const NumberError e = read_double(text, values[k]);
          e != NumberError::none && e != NumberError::too_small)
        fail("\"" + text + "\" " + describe(e));
    }
    if (!data.T.empty() && values[0] < data.T.back()) fail("T must not decrease");
    data.T.push_back(values[0]);
    data.Z.push_back(values[1]);
  }
  if (data.T.empty()) fail("holds no data");
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
    const auto next = std::lower_bound(c.T.begin(), c.T.end(), data.T[k]);
    if (next == c.T.end() || (next == c.T.begin() && *next > data.T[k])) continue;
    const auto i = std::size_t(next - c.T.begin());
    double z = c.Z[i];
    if (i > 0) z += (c.Z[i - 1] - z) * (c.T[i] - data.T[k]) / (c.T[i] - c.T[i - 1]);
    squares += (z - data.Z[k]) * (z - data.Z[k]);
    ++n;
  }
  if (points) *points = n;
  return n ? std::sqrt(squares / double(n)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace pbf
