// RunReader: the log, the gauges, and what was compared with measurements.
#include <algorithm>
#include <limits>

#include "lib/io/h5_output.h"
#include "lib/io/run_file.h"
#include "lib/io/run_layout.h"
#include "lib/io/with_run_file.h"

namespace pbf::io_module {
namespace {

const std::string kGauges = std::string("pbf/gauges");

/// Rows that all columns have. A process killed while it wrote the log may leave columns of
/// different lengths.
hsize_t rows_of_log(hid_t log) {
  hsize_t rows = std::numeric_limits<hsize_t>::max();
  for (const auto& c : run_layout::log_columns())
    if (h5::has_link(log, c.name))  // else of a later version than the file's
      rows = std::min(rows, h5::shape(h5::open_dataset(log, c.name)).at(0));
  return rows;
}

}  // namespace

std::vector<std::string> RunReader::log_columns() const {
  return with_file(path_, "cannot read the log", [](const h5::Reading& file) {
    return h5::datasets_below(h5::open_group(file, "pbf/log"), run_layout::log_groups);
  });
}

std::vector<std::string> RunReader::gauges() const {
  return with_file(path_, "cannot read the gauges", [](const h5::Reading& file) {
    if (!h5::has_link(file, kGauges)) return std::vector<std::string>{};
    return h5::datasets_below(h5::open_group(file, kGauges), 1);
  });
}

std::vector<double> RunReader::gauge(const std::string& name) const {
  const std::vector<std::string> all = gauges();
  if (std::ranges::find(all, name) == all.end()) return {};
  return with_file(path_, "cannot read the gauges", [&](const h5::Reading& file) {
    const h5::Group group = h5::open_group(file, kGauges);
    hsize_t rows = std::numeric_limits<hsize_t>::max();
    // A process killed while it wrote them may leave columns of different lengths.
    for (const std::string& each : all)
      rows = std::min(rows, h5::shape(h5::open_dataset(group, each)).at(0));
    return h5::read_all<double>(group, name, rows);
  });
}

RunColumn RunReader::column(const std::string& path) const {
  const std::size_t slash = path.find('/');
  const std::string name = path.substr(slash + 1);
  RunColumn out;
  out.values = path.starts_with("gauges/") ? gauge(name) : log_column(name);
  if (out.values.empty()) return out;
  with_file(path_, "cannot read " + path, [&](const h5::Reading& file) {
    const h5::Dataset d = h5::open_dataset(file, "pbf/" + path);
    const auto dims = h5::shape(d);
    out.components = dims.size() == 2 ? static_cast<int>(dims[1]) : 1;
    if (h5::has_attribute(d, "units")) out.unit = h5::read_text(d, "units");
    if (h5::has_attribute(d, "kind")) out.kind = h5::read_text(d, "kind");
  });
  return out;
}

std::vector<StoredComparison> RunReader::comparisons() const {
  return with_file(path_, "cannot read the comparisons", [](const h5::Reading& file) {
    std::vector<StoredComparison> all;
    const std::string path = std::string("pbf/") + run_layout::compare;
    if (!h5::has_link(file, path)) return all;
    const h5::Group group = h5::open_group(file, path);
    for (const std::string& name : h5::children(group, H5O_TYPE_GROUP)) {
      StoredComparison& c = all.emplace_back(StoredComparison{name});
      const h5::Group one = h5::open_group(group, name);
      for (const std::string& number : h5::children(one, H5O_TYPE_DATASET)) {
        const std::vector<double> value = h5::read_all<double>(one, number);
        const h5::Dataset d = h5::open_dataset(one, number);
        if (value.size() != 1)
          throw h5::Failure(path + "/" + name + "/" + number + " is no number");
        c.numbers.push_back({number, h5::read_text(d, "units"), value[0]});
      }
      for (const char* text : {"file", "note"})
        if (h5::has_attribute(one, text)) c.texts.emplace_back(text, h5::read_text(one, text));
    }
    return all;
  });
}

std::vector<double> RunReader::log_column(const std::string& name) const {
  return with_file(path_, "cannot read the log",
                   [&](const h5::Reading& file) -> std::vector<double> {
                     const h5::Group log = h5::open_group(file, "pbf/log");
                     if (name.empty() || !h5::has_link(log, name)) return {};
                     return h5::read_all<double>(log, name, rows_of_log(log));
                   });
}

std::map<std::string, std::vector<double>> RunReader::log() const {
  return with_file(path_, "cannot read the log", [](const h5::Reading& file) {
    std::map<std::string, std::vector<double>> all;
    const h5::Group log = h5::open_group(file, "pbf/log");
    const hsize_t rows = rows_of_log(log);
    for (const std::string& name : h5::datasets_below(log, run_layout::log_groups))
      all[name] = h5::read_all<double>(log, name, rows);
    return all;
  });
}

}  // namespace pbf::io_module
