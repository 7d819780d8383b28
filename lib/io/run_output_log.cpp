// RunOutput: the log, one column per number, written in batches.
#include <algorithm>

#include "lib/io/run_layout.h"
#include "lib/io/run_output.h"

namespace pbf::inline io_module {
namespace {

using run_layout::log_rows;

constexpr std::size_t max_waiting_rows = 256;
constexpr double max_waiting_seconds = 5;

}  // namespace

void RunOutput::log(const LogRow& row) {
  if (waiting_.empty()) since_log_.reset();
  waiting_.push_back(row);
  if (waiting_.size() >= max_waiting_rows || since_log_.seconds() > max_waiting_seconds) {
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
  write_stages();
  waiting_.clear();
}

/// A stage that a row does not name took no time in it.
void RunOutput::write_stages() {
  const hsize_t first = log_.at("time").rows() - waiting_.size();
  for (const LogRow& row : waiting_)
    for (const StageTime& stage : row.stages)
      if (h5::Column& column = stages_[stage.name]; !column.open()) {
        column =
            h5::Column(pbf_, "log/stage/" + stage.name, H5T_IEEE_F64LE, {log_rows, 0, false, "s"});
        column.append(std::vector<double>(first, 0.0));
      }
  for (auto& [name, column] : stages_) {
    std::vector<double> seconds;
    for (const LogRow& row : waiting_) {
      seconds.push_back(0);
      for (const StageTime& stage : row.stages)
        if (stage.name == name) seconds.back() += stage.seconds;
    }
    column.write(first, seconds.size(), H5T_NATIVE_DOUBLE, seconds.data());
  }
}

}  // namespace pbf::inline io_module
