#include "lib/data/measured.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/data/units.h"
#include "lib/io/csv.h"
#include "lib/io/run_path.h"
#include "lib/scene/difference.h"
#include "lib/scene/number.h"
#include "lib/scene/suggest.h"

namespace pbf::data_module {
namespace {

namespace fs = std::filesystem;

bool is_time(const std::string& column) { return column == "t" || column == "time"; }

class TableReader {
 public:
  TableReader(const Comparison& c, const Quantity& q, std::string file, std::string key)
      : c_(c), q_(q), file_(std::move(file)), key_(std::move(key)) {}

  Measured read() {
    Measured out;
    rows_ = read_csv(file_, "", &out.sha256);
    if (rows_.size() < 2)
      fail(file_, "holds no rows of numbers; a header with the names of the columns comes first");
    const std::size_t t = time_column(), x = value_column();
    const double second = time_factor(head(t)), factor = value_factor(head(x));
    for (std::size_t r = 1; r < rows_.size(); ++r) {
      const double time = second * number(r, t);
      if (std::isnan(time)) fail(rows_[r].where, "has no time in column " + head(t));
      // Digitised curves have steps: several values at one time.
      if (!out.time.empty() && !(time >= out.time.back()))
        fail(rows_[r].where, "time " + cell(r, t) + " does not follow " + cell(r - 1, t) +
                                 "; times must not decrease");
      out.time.push_back(time);
      out.value.push_back(factor * number(r, x) + c_.offset);
    }
    if (std::ranges::none_of(out.value, [](double v) { return std::isfinite(v); }))
      fail(file_, "column " + head(x) + " holds no number");
    out.column = head(x);
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    bad_input(key_, where + ": " + what);
  }
  const std::string& cell(std::size_t row, std::size_t column) const {
    return rows_[row].cells[column];
  }
  const std::string& head(std::size_t column) const { return cell(0, column); }
  std::string all_columns() const { return "; there are " + first_of(rows_[0].cells, 20); }

  /// NaN for an empty cell and for nan.
  double number(std::size_t row, std::size_t column) const {
    const std::string& text = cell(row, column);
    std::string lower = text;
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
    if (text.empty() || lower == "nan") return NAN;
    double value = 0;
    const NumberError e = read_number(text, value);
    if ((e != NumberError::none && e != NumberError::too_small) || !std::isfinite(value))
      fail(rows_[row].where, head(column) + ": \"" + text.substr(0, 40) + "\" is not a number");
    return value;
  }

  std::size_t named(const std::string& name, const char* which) const {
    const auto at = std::ranges::find(rows_[0].cells, name);
    if (at != rows_[0].cells.end()) return std::size_t(at - rows_[0].cells.begin());
    const std::string near = nearest_word(name, rows_[0].cells);
    fail(rows_[0].where,
         fmt::format("no {} {}{}", which, name,
                     near.empty() ? all_columns() : "; did you mean " + near + "?") +
             separator_remedy(head(0)));
  }

  std::size_t time_column() const {
    if (!c_.time_column.empty()) return named(c_.time_column, "column of times");
    for (std::size_t k = 0; k < rows_[0].cells.size(); ++k)
      if (is_time(head(k)) || is_time(named_unit(head(k)).name)) return k;
    return 0;
  }

  std::size_t value_column() const {
    if (!c_.column.empty()) return named(c_.column, "column");
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < rows_[0].cells.size(); ++k)
      for (const std::string& name : q_.names)
        if (head(k) == name || named_unit(head(k)).name == name) {
          found.push_back(k);
          break;
        }
    if (found.size() == 1) return found[0];
    fail(rows_[0].where, (found.empty() ? "no column is named as the reading, " + q_.names[0]
                                        : "columns " + head(found[0]) + " and " + head(found[1]) +
                                              " are both named as the reading") +
                             "; give column: NAME" + all_columns() + separator_remedy(head(0)));
  }

  double time_factor(const std::string& column) const {
    const NamedUnit named = named_unit(column);
    if (named.unit && std::string(named.unit->unit) == "s")
      return c_.time_scale.value_or(named.unit->factor);
    if (c_.time_scale) return *c_.time_scale;
    if (is_time(column)) return 1;
    fail(rows_[0].where, "column " + column + " has no unit of time; give " +
                             key_word(c_, "time_scale") + ", the seconds of one unit, or " +
                             key_word(c_, "time_column") + " and the name of another column");
  }

  double value_factor(const std::string& column) const {
    const NamedUnit named = named_unit(column);
    const std::string& unit = q_.site.unit;
    if (c_.scale) return *c_.scale;
    if (named.unit && unit == named.unit->unit) return named.unit->factor;
    if (named.unit)
      fail(rows_[0].where, fmt::format("column {} is in {}, and {} is in {}; name another column, "
                                       "or give {}, the {} of one {}",
                                       column, named.unit->ending + 1, q_.names[0], unit,
                                       key_word(c_, "scale"), unit, named.unit->unit));
    if (unit == "1") return 1;
    fail(rows_[0].where,
         fmt::format("column {} has no unit; end its name in one ({}{}), or give {}, the {} of "
                     "one unit",
                     column, column, unit_ending(unit), key_word(c_, "scale"), unit));
  }

  const Comparison& c_;
  const Quantity& q_;
  std::string file_, key_;
  std::vector<CsvRow> rows_;
};

Measured read_run(const Comparison& c, const Quantity& quantity, const std::string& file,
                  const std::string& key) {
  if (!c.time_column.empty())
    bad_input(key, file + " is a run, whose times are known; remove time_column");
  try_run_file(file);
  const RunReader run(file);
  const Readings readings = readings_of(run);
  Quantity q = quantity;
  if (!c.column.empty()) {
    const std::string path = c.column.starts_with("gauges/") || c.column.starts_with("log/")
                                 ? c.column
                             : readings.find("gauges/" + c.column) ? "gauges/" + c.column
                                                                   : "log/" + c.column;
    q.path = path;
  }
  const std::optional<ReadingSite> site = readings.find(q.path);
  if (!site)
    bad_input(key,
              file + " has no reading " + q.path + "; there are " + first_of(readings.names(), 20));
  q.site = *site;
  if (q.site.unit != quantity.site.unit && !c.scale)
    bad_input(key, fmt::format("{} of {} is in {}, and {} in {}; name another reading", q.path,
                               file, q.site.unit, quantity.names[0], quantity.site.unit));
  if (q.site.components <= q.component)
    bad_input(key, file + ": " + q.path + " is no vector, and " + quantity.names[0] +
                       " is one of "
                       "its components");
  QuantitySeries s = read_quantity(run, q);
  Measured out{std::move(s.time), std::move(s.value), site->means, {}, q.path, {}};
  for (double& t : out.time) t *= c.time_scale.value_or(1);
  for (double& v : out.value) v = c.scale.value_or(1) * v + c.offset;
  return out;
}

}  // namespace

Measured read_measured(const Comparison& c, const Quantity& quantity, const std::string& folder,
                       const std::string& key) {
  std::string file = (fs::path(folder) / c.data).string();
  std::error_code error;
  Measured out;
  try {
    if (fs::is_directory(file, error)) file = only_run_path(file);
    out = is_hdf5_file(file) ? read_run(c, quantity, file, key)
                             : TableReader(c, quantity, file, key).read();
  } catch (const Error& e) {
    if (std::string(e.what()).starts_with(key)) throw;
    throw Error(e.code(), key + ": " + e.what() +
                              (e.code() == ExitCode::io && !fs::exists(file, error)
                                   ? "; its path counts from the folder of the scene file"
                                   : ""));
  }
  out.file = fs::absolute(file).string();
  return out;
}

}  // namespace pbf::data_module
