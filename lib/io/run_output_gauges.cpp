// RunOutput: readings of gauges, one column per number or vector, written in batches as the log is.
#include <algorithm>

#include "lib/io/h5_output.h"
#include "lib/io/h5_read.h"
#include "lib/io/run_layout.h"
#include "lib/io/run_output.h"

namespace pbf::io_module {

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
  if (waiting_gauges_.empty()) since_gauges_.reset();
  waiting_gauges_.push_back(row);
  if (waiting_gauges_.size() >= run_layout::waiting_rows ||
      since_gauges_.seconds() > run_layout::waiting_seconds) {
    write_gauges();
    flush();
  }
}

void RunOutput::write_gauges() {
  if (waiting_gauges_.empty()) return;
  std::vector<double> numbers;
  std::vector<std::int64_t> updates;
  for (const GaugeRow& row : waiting_gauges_) {
    numbers.push_back(row.time);
    updates.push_back(row.update);
  }
  gauges_[0].append(numbers);
  gauges_[1].append(updates);
  std::size_t next = 2, first = 0;
  for (const ReadingColumn& c : columns_) {
    if (c.series != Series::gauges) continue;
    const auto components = std::size_t(c.components);
    numbers.clear();
    for (const GaugeRow& row : waiting_gauges_)
      for (std::size_t k = 0; k < components; ++k) numbers.push_back(row.numbers.at(first + k));
    gauges_[next++].append(numbers);
    first += components;
  }
  waiting_gauges_.clear();
}

}  // namespace pbf::io_module
