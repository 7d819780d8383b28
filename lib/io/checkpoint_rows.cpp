#include "lib/io/checkpoint_rows.h"

#include <algorithm>

#include "lib/base/error.h"
#include "lib/io/h5_output.h"
#include "lib/io/h5_read.h"

namespace pbf::io_module {
namespace {

using h5::check;

constexpr hsize_t kChunk = kCheckpointRows;

/// Rows of `components` numbers, with a checksum per chunk (Fletcher 32).
template <class T>
void write_rows(hid_t file, const char* name, const char* unit, hid_t type, hsize_t components,
                const std::vector<T>& values) {
  const hsize_t rows = values.size() / components;
  const hsize_t chunk[2] = {std::clamp<hsize_t>(rows, 1, kChunk), components};
  const h5::Properties create(H5Pcreate(H5P_DATASET_CREATE));
  check(H5Pset_chunk(create, 2, chunk));
  check(H5Pset_fletcher32(create));
  h5::write_dataset(file, name, type, {rows, components}, h5::native<T>(), values.data(), unit,
                    create);
}

/// The same in pieces, from the first row on. Members throw h5::Failure.
class RowsInPieces {
 public:
  RowsInPieces(hid_t file, const char* name, const char* unit, hid_t type, hsize_t components,
               hsize_t rows) {
    const hsize_t size[2] = {rows, components};
    const hsize_t chunk[2] = {std::clamp<hsize_t>(rows, 1, kChunk), components};
    const h5::Properties create(H5Pcreate(H5P_DATASET_CREATE));
    check(H5Pset_chunk(create, 2, chunk));
    check(H5Pset_fletcher32(create));
    const h5::Space space(H5Screate_simple(2, size, nullptr));
    dataset_ = h5::Dataset(H5Dcreate2(file, name, type, space, H5P_DEFAULT, create, H5P_DEFAULT));
    h5::write_text(dataset_, "units", unit);
    components_ = components;
  }
  template <class T>
  void add(const std::vector<T>& values) {
    const hsize_t start[2] = {rows_, 0}, block[2] = {values.size() / components_, components_};
    if (block[0] == 0) return;
    const h5::Space file(H5Dget_space(dataset_)), memory(H5Screate_simple(2, block, nullptr));
    check(H5Sselect_hyperslab(file, H5S_SELECT_SET, start, nullptr, block, nullptr));
    check(H5Dwrite(dataset_, h5::native<T>(), memory, file, H5P_DEFAULT, values.data()));
    rows_ += block[0];
  }

 private:
  h5::Dataset dataset_;
  hsize_t components_ = 1, rows_ = 0;
};

template <class T>
void read_rows(hid_t file, const char* name, std::int64_t n, std::size_t components,
               std::vector<T>& values) {
  if (h5::shape(h5::open_dataset(file, name)) != std::vector{hsize_t(n), hsize_t(components)})
    throw h5::Failure(std::string("dataset ") + name + " has the wrong size");
  values = h5::read_all<T>(file, name);
}

/// The rows of a field of the state besides the particles' places.
StoredField read_field(hid_t file, const std::string& name) {
  const std::vector<hsize_t> size = h5::shape(h5::open_dataset(file, name.c_str()));
  if (size.size() != 2 || size[1] < 1 || size[1] > 1000)
    throw h5::Failure("dataset " + name + " has the wrong size");
  StoredField f{name, false, int(size[1])};
  read_rows(file, name.c_str(), std::int64_t(size[0]), std::size_t(size[1]), f.values);
  return f;
}

/// Datasets of a checkpoint besides the particles' places.
std::vector<std::string> further_datasets(hid_t file) {
  std::vector<std::string> names = h5::children(file, H5O_TYPE_DATASET);
  std::erase_if(names, [](const std::string& name) {
    return name == "position" || name == "velocity" || name == "id";
  });
  return names;
}
/// So many rows of a dataset from `first` on, which must have `all`.
template <class T>
std::vector<T> read_piece(hid_t file, const char* name, hsize_t all, hsize_t components,
                          hsize_t first, hsize_t rows) {
  const h5::Dataset d = h5::open_dataset(file, name);
  if (h5::shape(d) != std::vector{all, components})
    throw h5::Failure(std::string("dataset ") + name + " has the wrong size");
  std::vector<T> values(h5::claimed(d, {rows, components}, sizeof(T)));
  if (!values.empty()) h5::read_block(d, first, {rows, components}, h5::native<T>(), values.data());
  return values;
}
/// Rows of the state of n particles, with the fields of as many rows.
SolverState read_state_piece(hid_t file, hsize_t n, hsize_t first, hsize_t rows) {
  SolverState s;
  s.position = read_piece<double>(file, "position", n, 3, first, rows);
  s.velocity = read_piece<double>(file, "velocity", n, 3, first, rows);
  s.id = read_piece<std::int64_t>(file, "id", n, 1, first, rows);
  for (std::size_t k = 0; k < s.id.size(); ++k)
    if (s.id[k] != std::int64_t(first + k)) throw h5::Failure("dataset id is not 0, 1, 2 ...");
  for (const std::string& name : further_datasets(file)) {
    const auto size = h5::shape(h5::open_dataset(file, name));
    if (size.size() != 2 || size[0] != n || size[1] < 1 || size[1] > 1000) continue;
    s.fields.push_back({name, false, int(size[1]),
                        read_piece<double>(file, name.c_str(), n, size[1], first, rows)});
  }
  return s;
}
}  // namespace

void write_state(hid_t file, const SolverState& s) {
  const hid_t real = s.precision == Precision::dbl ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
  write_rows(file, "position", "h", real, 3, s.position);
  write_rows(file, "velocity", "h/s", real, 3, s.velocity);
  const auto largest = std::ranges::max_element(s.id);
  const bool long_ids = largest != s.id.end() && *largest > 2147483647;
  write_rows(file, "id", "1", long_ids ? H5T_STD_I64LE : H5T_STD_I32LE, 1, s.id);
  for (const StoredField& f : s.fields)
    write_rows(file, f.name.c_str(), "1", f.real ? real : H5T_IEEE_F64LE, hsize_t(f.numbers),
               f.values);
}
void write_pieces(hid_t file, const GiveState& give, std::int64_t n, SolverState& head) {
  std::vector<RowsInPieces> columns;
  hid_t real = H5T_IEEE_F64LE;
  const auto add = [&](const char* name, const char* unit, hid_t type, int components) {
    columns.emplace_back(file, name, unit, type, hsize_t(components), hsize_t(n));
  };
  give({[&](SolverState&& h) {
          head = std::move(h);
          if (head.precision != Precision::dbl) real = H5T_IEEE_F32LE;
          for (const StoredField& f : head.fields)
            if (!f.values.empty())
              write_rows(file, f.name.c_str(), "1", f.real ? real : H5T_IEEE_F64LE,
                         hsize_t(f.numbers), f.values);
        },
        [&](std::int64_t, SolverState&& rows) {
          if (columns.empty()) {
            add("position", "h", real, 3);
            add("velocity", "h/s", real, 3);
            add("id", "1", H5T_STD_I32LE, 1);
            for (const StoredField& f : rows.fields)
              add(f.name.c_str(), "1", f.real ? real : H5T_IEEE_F64LE, f.numbers);
          }
          columns[0].add(rows.position), columns[1].add(rows.velocity), columns[2].add(rows.id);
          for (std::size_t k = 0; k < rows.fields.size(); ++k)
            columns[3 + k].add(rows.fields[k].values);
        }});
}

void read_state(hid_t file, std::int64_t particles, SolverState& s) {
  read_rows(file, "position", particles, 3, s.position);
  read_rows(file, "velocity", particles, 3, s.velocity);
  read_rows(file, "id", particles, 1, s.id);
  for (const std::string& name : further_datasets(file)) s.fields.push_back(read_field(file, name));
}
void read_head(hid_t file, std::int64_t particles, SolverState& s) {
  constexpr hsize_t kFew = 1 << 16;
  const auto n = hsize_t(particles);
  for (hsize_t at = 0; at < n; at += kChunk)
    read_state_piece(file, n, at, std::min(kChunk, n - at));
  for (const std::string& name : further_datasets(file)) {
    const auto size = h5::shape(h5::open_dataset(file, name));
    if (size.empty() || size[0] != n || n <= kFew)
      s.fields.push_back(read_field(file, name));
    else
      s.fields.push_back({name, false, int(size.at(1)), {}});
  }
}

SolverState CheckpointRows::read(std::int64_t first, std::int64_t rows) const {
  try {
    const h5::Reading file(path_);
    const auto n = h5::read_number<std::int64_t>(file, "particles");
    return read_state_piece(file, hsize_t(n), hsize_t(first), hsize_t(rows));
  } catch (const h5::Failure& f) {
    throw Error(ExitCode::io, path_ + ": cannot be read again: " + f.what());
  }
}

}  // namespace pbf::io_module
