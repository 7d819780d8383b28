#include "lib/io/checkpoint.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/own_file.h"
#include "lib/base/regular_file.h"
#include "lib/io/h5_output.h"
#include "lib/io/h5_read.h"
#include "lib/io/h5_trial.h"
#include "lib/scene/scene_files.h"

namespace pbf::inline io_module {
namespace {

namespace fs = std::filesystem;
using h5::check;

constexpr std::int64_t kFormat = 2;
constexpr hsize_t kChunkRows = hsize_t{1} << 18;

/// Rows of `components` numbers, with a checksum per chunk (Fletcher 32).
template <class T>
void write_rows(hid_t file, const char* name, const char* unit, hid_t type, hsize_t components,
                const std::vector<T>& values) {
  const hsize_t rows = values.size() / components, size[2] = {rows, components};
  const hsize_t chunk[2] = {std::clamp<hsize_t>(rows, 1, kChunkRows), components};
  const h5::Space space(H5Screate_simple(2, size, nullptr));
  const h5::Properties create(H5Pcreate(H5P_DATASET_CREATE));
  check(H5Pset_chunk(create, 2, chunk));
  check(H5Pset_fletcher32(create));
  const h5::Dataset d(H5Dcreate2(file, name, type, space, H5P_DEFAULT, create, H5P_DEFAULT));
  if (rows > 0) check(H5Dwrite(d, h5::native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  h5::write_text(d, "units", unit);
}

template <class T>
void read_rows(hid_t file, const char* name, std::int64_t n, std::size_t components,
               std::vector<T>& values) {
  const h5::Dataset d = h5::open_dataset(file, name);
  const std::vector<hsize_t> size = h5::shape(d);
  if (size != std::vector<hsize_t>{static_cast<hsize_t>(n), components})
    throw h5::Failure(std::string("dataset ") + name + " has the wrong size");
  values.resize(h5::claimed(d, size, sizeof(T)));
  if (!values.empty())
    check(H5Dread(d, h5::native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

/// f(attribute name, number) of the members that are doubles: one list for both directions.
template <class Saved, class F>
void for_each_number(Saved& s, F&& f) {
  f("energy_first", s.energy.first);
  f("energy_lowest", s.energy.lowest);
  f("energy_rise", s.energy.rise);
  f("compression_max", s.compression_max);
  f("first_kinetic_energy", s.first.kinetic_energy);
  f("first_potential_energy", s.first.potential_energy);
  f("first_compression_mean", s.first.compression_mean);
  f("first_speed_max", s.first.speed_max);
  f("first_center_of_mass_x", s.first.center_of_mass[0]);
  f("first_center_of_mass_y", s.first.center_of_mass[1]);
  f("first_center_of_mass_z", s.first.center_of_mass[2]);
}

/// The same for those that older files lack.
template <class Saved, class F>
void for_each_newer_number(Saved& s, F&& f) {
  f("energy_largest", s.energy.largest);
  f("way_squared", s.state.way_squared);
  f("first_momentum_x", s.first.momentum[0]);
  f("first_momentum_y", s.first.momentum[1]);
  f("first_momentum_z", s.first.momentum[2]);
}

/// The same for the numbers of a StepHistory but its list. Their names begin with "step_".
template <class History, class Integer, class Number>
void for_each_step(History& s, Integer&& integer, Number&& number) {
  integer("step_level", s.level);
  integer("step_hold", s.hold);
  integer("step_hold_length", s.hold_length);
  integer("step_coarse", s.coarse);
  integer("step_changes", s.changes);
  integer("step_repeats", s.repeats);
  integer("step_floor", s.floor);
  integer("step_since", s.since);
  number("step_time", s.time);
  number("step_speed", s.speed);
}

void write_steps(hid_t file, const StepHistory& s) {
  const auto write = [&](const char* name, const auto& v) { h5::write_numbers(file, name, &v); };
  for_each_step(s, write, write);
  write("step_unresolved", s.unresolved);
  h5::write_numbers(file, "step_updates", s.updates.data(), s.updates.size());
}

StepHistory read_steps(hid_t file) {
  StepHistory s;
  const auto read = [&](const char* name, auto& v) {
    v = h5::read_number<std::remove_reference_t<decltype(v)>>(file, name);
  };
  for_each_step(s, read, read);
  if (h5::has_attribute(file, "step_unresolved")) read("step_unresolved", s.unresolved);
  s.updates = h5::read_integers(file, "step_updates");
  if (s.level < 0 || s.level >= std::int64_t(s.updates.size()))
    throw h5::Failure("a level of the step that cannot be");
  return s;
}

void write_file(const std::string& path, const SavedRun& s) {
  const h5::Properties access = h5::writer_access();
  ::unlink(path.c_str());  // what a killed run has left; whatever is there is not followed
  h5::File file(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access));
  try {
    const bool wide = s.state.precision == Precision::dbl;
    const hid_t real = wide ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
    write_rows(file, "position", "h", real, 3, s.state.position);
    write_rows(file, "velocity", "h/s", real, 3, s.state.velocity);
    write_rows(file, "id", "1", H5T_STD_I32LE, 1, s.state.id);
    const std::int64_t started = s.energy.started;
    h5::write_numbers(file, "format_version", &kFormat);
    h5::write_text(file, "precision", wide ? "double" : "float");
    h5::write_numbers(file, "update", &s.state.updates);
    h5::write_numbers(file, "steps", &s.state.steps);
    h5::write_numbers(file, "particles", &s.particles);
    h5::write_numbers(file, "fast", &s.state.fast);
    h5::write_numbers(file, "rounds", &s.state.repeats);
    h5::write_numbers(file, "unresolved", &s.state.unresolved);
    h5::write_numbers(file, "first_neighbors_max", &s.first.neighbors_max);
    h5::write_numbers(file, "energy_started", &started);
    h5::write_numbers(file, "compressed_updates", &s.compressed_updates);
    const auto write = [&](const char* name, double v) { h5::write_numbers(file, name, &v); };
    for_each_number(s, write);
    for_each_newer_number(s, write);
    if (s.released) write("released_energy", *s.released);
    if (s.steps) write_steps(file, *s.steps);
    h5::write_text(file, "resolved_scene", s.scene);
    h5::write_text(file, "scene_files", s.files);
    h5::write_text(file, "scene_sha256", scene_digest(s.scene, s.files));
    h5::flush_reserved(file);
    h5::sync(file);
  } catch (...) {
    h5::abandon(file);
    throw;
  }
  if (!file.reset()) throw h5::Failure(h5::reason());
}

SavedRun read_file(const std::string& path) {
  require_own_file(path);
  const h5::Reading file(path);
  const auto format = h5::read_number<std::int64_t>(file, "format_version");
  if (format != kFormat)
    throw h5::Failure("format version " + std::to_string(format) + "; this program reads version " +
                      std::to_string(kFormat));
  SavedRun s;
  s.state.precision =
      h5::read_text(file, "precision") == "double" ? Precision::dbl : Precision::single;
  s.state.updates = h5::read_number<std::int64_t>(file, "update");
  // Files written before there were levels hold neither.
  s.state.steps = h5::has_attribute(file, "steps") ? h5::read_number<std::int64_t>(file, "steps")
                                                   : s.state.updates;
  if (h5::has_attribute(file, "step_level")) s.steps = read_steps(file);
  s.particles = h5::read_number<std::int64_t>(file, "particles");
  s.state.fast = h5::read_number<std::int64_t>(file, "fast");
  s.state.repeats = h5::read_number<std::int64_t>(file, "rounds");
  if (h5::has_attribute(file, "unresolved"))  // newer as well
    s.state.unresolved = h5::read_number<std::int64_t>(file, "unresolved");
  if (h5::has_attribute(file, "compressed_updates"))
    s.compressed_updates = h5::read_number<std::int64_t>(file, "compressed_updates");
  s.first.neighbors_max = h5::read_number<std::int64_t>(file, "first_neighbors_max");
  s.energy.started = h5::read_number<std::int64_t>(file, "energy_started") != 0;
  const auto read = [&](const char* name, double& v) { v = h5::read_number<double>(file, name); };
  for_each_number(s, read);
  for_each_newer_number(s, [&](const char* name, double& v) {
    if (h5::has_attribute(file, name)) read(name, v);
  });
  if (h5::has_attribute(file, "released_energy")) read("released_energy", s.released.emplace());
  if (h5::has_attribute(file, "scene_sha256")) {
    s.scene = h5::read_text(file, "resolved_scene");
    s.files = h5::read_text(file, "scene_files");
    if (h5::read_text(file, "scene_sha256") != scene_digest(s.scene, s.files))
      throw h5::Failure("its scene is not the one that it was written with (SHA-256 differs)");
  }
  if (s.particles < 0 || s.particles > 2147483647 || s.state.updates < 0)
    throw h5::Failure("a number of particles or updates that cannot be");
  read_rows(file, "position", s.particles, 3, s.state.position);
  read_rows(file, "velocity", s.particles, 3, s.state.velocity);
  read_rows(file, "id", s.particles, 1, s.state.id);
  std::vector<bool> seen(s.state.id.size());
  for (const std::int32_t id : s.state.id) {
    if (id < 0 || id >= s.particles || seen[static_cast<std::size_t>(id)])
      throw h5::Failure("dataset id does not hold every number from 0 on once");
    seen[static_cast<std::size_t>(id)] = true;
  }
  return s;
}

/// As anything, a link that leads nowhere or to itself too.
bool is_there(const std::string& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

/// In a process of its own first: HDF5 may crash on what is damaged. Failure.
SavedRun try_and_read(const std::string& path) {
  try {
    if (not_regular(path).empty()) h5::trial(path, [&path] { read_file(path); });
  } catch (const Error& e) {
    throw h5::Failure(e.what());
  }
  return read_file(path);
}

void rename_or_fail(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) throw h5::Failure(std::strerror(errno));
}

}  // namespace

void write_checkpoint(const std::string& folder, const SavedRun& saved) {
  const std::string path = folder + "/checkpoint.h5", temporary = path + ".tmp";
  try {
    {
      const h5::Lock lock;
      write_file(temporary, saved);
    }
    if (is_there(path)) rename_or_fail(path, folder + "/checkpoint_prev.h5");
    rename_or_fail(temporary, path);
    h5::sync_folder(folder);
  } catch (const h5::Failure& f) {
    ::unlink(temporary.c_str());
    throw Error(ExitCode::io, path + ": cannot write the checkpoint: " + f.what() +
                                  "; free space and give --resume to go on from the one before");
  }
}

std::optional<SavedRun> read_checkpoint(const std::string& folder,
                                        std::vector<std::string>& notes) {
  std::string damaged;
  for (const char* name : {"checkpoint.h5", "checkpoint_prev.h5"}) {
    const std::string path = folder + "/" + name;
    if (!is_there(path)) continue;
    try {
      SavedRun saved = try_and_read(path);
      if (!damaged.empty()) notes.push_back(damaged + "; the one before it is taken");
      return saved;
    } catch (const h5::Failure& f) {
      damaged += (damaged.empty() ? "" : "; ") + path;
      damaged += std::string(": the checkpoint cannot be read: ") + f.what();
    }
  }
  if (damaged.empty()) return std::nullopt;
  throw Error(ExitCode::io, damaged + "; remove it to start again from the first update");
}

}  // namespace pbf::inline io_module
