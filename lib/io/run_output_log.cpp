// RunOutput: the log, one column per number, written in batches.
#include <algorithm>

#include "lib/io/run_layout.h"
#include "lib/io/run_output.h"

namespace pbf::io_module {
namespace {

using run_layout::log_rows;

}  // namespace

void RunOutput::log(const LogRow& row) {
  if (waiting_.empty()) since_log_.reset();
  waiting_.push_back(row);
  if (waiting_.size() >= run_layout::waiting_rows ||
      since_log_.seconds() > run_layout::waiting_seconds) {
    write_log();
    flush();
  }
}

void RunOutput::write_log() {
  if (waiting_.empty()) return;
  std::vector<std::int64_t> integers(waiting_.size());
  std::vector<double> numbers(waiting_.size());
  for (const auto& c : run_layout::log_columns()) {
    h5::Column& column = log_.at(c.name);
    if (c.real) {
      std::transform(waiting_.begin(), waiting_.end(), numbers.begin(),
                     [&](const LogRow& row) { return c.value(row); });
      column.append(numbers);
    } else {
      std::transform(waiting_.begin(), waiting_.end(), integers.begin(),
                     [&](const LogRow& row) { return c.whole(row); });
      column.append(integers);
    }
  }
  write_further();
  waiting_.clear();
}

/// What a row does not name is 0 in it: a stage that took no time.
void RunOutput::write_further() {
  const hsize_t first = log_.at("time").rows() - waiting_.size();
  std::map<std::string, std::vector<double>> values;
  for (std::size_t k = 0; k < waiting_.size(); ++k)
    for (const auto& n : run_layout::further_numbers(waiting_[k], columns_)) {
      if (h5::Column& column = further_[n.column]; !column.open()) {
        column = h5::Column(pbf_, "log/" + n.column, H5T_IEEE_F64LE, {log_rows, 0, false, n.unit});
        column.append(std::vector<double>(first, 0.0));
      }
      auto& rows = values[n.column];
      rows.resize(waiting_.size());
      rows[k] += n.value;
    }
  for (auto& [name, column] : further_) {
    auto& rows = values[name];
    rows.resize(waiting_.size());
    column.write(first, rows.size(), H5T_NATIVE_DOUBLE, rows.data());
  }
}

}  // namespace pbf::io_module
