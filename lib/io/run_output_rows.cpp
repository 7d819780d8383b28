// RunOutput: the log and the readings of gauges, one column per number or vector, written in
// batches; the free bodies of every frame.
#include "lib/base/error.h"
#include "lib/io/run_layout.h"
#include "lib/io/run_output.h"

namespace pbf::io_module {

void RunOutput::log(const LogRow& row) {
  if (waiting_.add(row)) flush();
  commit_if_due();
}

void RunOutput::write_log() {
  if (waiting_.rows.empty()) return;
  std::vector<double> numbers;
  for (const auto& c : run_layout::log_columns()) {
    numbers.clear();
    for (const LogRow& row : waiting_.rows) numbers.push_back(c.value(row));
    log_.at(c.name).append(numbers);
  }
  write_further();
  waiting_.rows.clear();
}

/// What a row does not name is 0 in it: a stage that took no time.
void RunOutput::write_further() {
  const std::size_t count = waiting_.rows.size();
  const hsize_t first = log_.at("time").rows() - count;
  std::map<std::string, std::vector<double>> values;
  for (std::size_t k = 0; k < count; ++k)
    for (const auto& n : run_layout::further_numbers(waiting_.rows[k], columns_)) {
      if (h5::Column& column = further_[n.column]; !column.open()) {
        column = h5::Column(pbf_, "log/" + n.column, H5T_IEEE_F64LE,
                            {run_layout::log_rows, 0, false, n.unit});
        column.append(std::vector<double>(first, 0.0));
      }
      auto& rows = values[n.column];
      rows.resize(count);
      rows[k] += n.value;
    }
  for (auto& [name, column] : further_) {
    auto& rows = values[name];
    rows.resize(count);
    column.write(first, count, H5T_NATIVE_DOUBLE, rows.data());
  }
}

void RunOutput::make_gauges(hsize_t rows) {
  const auto make = [&](const std::string& path, hid_t type, const char* unit, int components) {
    gauges_.push_back(column(pbf_, run_layout::gauges + path, type,
                             {run_layout::log_rows, components > 1 ? components : 0, false, unit},
                             rows));
  };
  for (const ReadingColumn& c : columns_) {
    if (c.series != Series::gauges) continue;
    if (gauges_.empty()) {
      make("time", H5T_IEEE_F64LE, "s", 1);
      make("update", H5T_STD_I64LE, "1", 1);
    }
    make(*c.name ? std::string(c.name) + "/" + c.of : c.of, H5T_IEEE_F64LE, c.unit, c.components);
    if (opening_ || *c.name) continue;
    const h5::Dataset dataset = h5::open_dataset(pbf_, run_layout::gauges + c.of);
    h5::write_text(dataset, "kind", c.kind);
    h5::write_text(dataset, "place", c.place);
  }
}

void RunOutput::gauges(const GaugeRow& row) {
  std::vector<double> numbers{row.time, double(row.update)};
  numbers.insert(numbers.end(), row.numbers.begin(), row.numbers.end());
  if (waiting_gauges_.add(std::move(numbers))) flush();
  commit_if_due();
}

void RunOutput::write_gauges() {
  std::size_t first = 0;
  for (h5::Column& column : gauges_) {
    std::vector<double> numbers;
    for (const std::vector<double>& row : waiting_gauges_.rows)
      for (std::size_t k = 0; k < column.width(); ++k) numbers.push_back(row.at(first + k));
    column.append(numbers);
    first += column.width();
  }
  waiting_gauges_.rows.clear();
}

void RunOutput::make_bodies(hsize_t frames) {
  if (body_names_.empty()) return;
  const h5::Layout layout{run_layout::body_rows, BodyMotion::kNumbers, false, "",
                          static_cast<int>(body_names_.size())};
  bodies_ = column(pbf_, run_layout::bodies, H5T_IEEE_F64LE, layout, frames);
  const std::vector<hsize_t> row{body_names_.size(), BodyMotion::kNumbers};
  const h5::Dataset dataset = h5::open_dataset(pbf_, run_layout::bodies);
  if (opening_) {
    if (bodies_.row() != row || h5::read_texts(dataset, "names") != body_names_)
      throw h5::Failure(std::string("/pbf/") + run_layout::bodies + " is not of these bodies");
    return;
  }
  h5::write_texts(dataset, "names", body_names_);
  std::vector<std::string> columns, units;
  for_each_number(body_columns(body_names_[0]), Series::poses,
                  [&](const ReadingColumn& c, int component, std::size_t) {
                    columns.push_back(number_name(c, component));
                    units.emplace_back(c.unit);
                  });
  h5::write_texts(dataset, "columns", columns);
  h5::write_texts(dataset, "units", units);
}

void RunOutput::check_bodies(const Snapshot& s, bool split) const {
  if (s.bodies.size() != body_names_.size() || (split && !s.bodies.empty()))
    throw Error(ExitCode::internal, "run file: bad snapshot: it has " +
                                        std::to_string(s.bodies.size()) + " free bodies, the run " +
                                        std::to_string(body_names_.size()));
}

void RunOutput::write_bodies(const Snapshot& s) {
  if (!bodies_.open()) return;
  std::vector<double> row;
  for (const BodyMotion& body : s.bodies)
    BodyMotion::each(body, [&](double x) { row.push_back(x); });
  bodies_.append(row);
}

}  // namespace pbf::io_module
