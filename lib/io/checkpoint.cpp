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
#include "lib/io/checkpoint_rows.h"
#include "lib/io/h5_output.h"
#include "lib/io/h5_read.h"
#include "lib/scene/scene_files.h"

namespace pbf::io_module {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kFormat = 3, kOldestFormat = 2;

/// f(attribute name, number, older files lack it) of the members that are numbers: one list for
/// both directions.
template <class Saved, class F>
void for_each_number(Saved& s, F&& f) {
  constexpr bool newer = true;
  f("update", s.state.updates);
  f("steps", s.state.steps, newer);
  f("particles", s.particles);
  f("first_neighbors_max", s.first.neighbors_max);
  f("energy_started", s.energy.started);
  f("compressed_updates", s.compressed_updates, newer);
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
  f("energy_largest", s.energy.largest, newer);
  f("energy_work", s.energy.work, newer);
  f("energy_power", s.energy.power, newer);
  f("energy_time", s.energy.time, newer);
  f("first_momentum_x", s.first.momentum[0], newer);
  f("first_momentum_y", s.first.momentum[1], newer);
  f("first_momentum_z", s.first.momentum[2], newer);
}

/// The same for the numbers of a StepHistory but its list. Their names begin with "step_".
template <class History, class F>
void for_each_step(History& s, F&& f) {
  f("step_level", s.level);
  f("step_hold", s.hold);
  f("step_hold_length", s.hold_length);
  f("step_coarse", s.coarse);
  f("step_changes", s.changes);
  f("step_repeats", s.repeats);
  f("step_floor", s.floor);
  f("step_since", s.since);
  f("step_time", s.time);
  f("step_speed", s.speed);
  f("step_unresolved", s.unresolved, true);
}

auto writing(hid_t file) {
  return [file](const char* name, const auto& v, bool = false) {
    using T = std::remove_cvref_t<decltype(v)>;
    h5::write_number(file, name, std::conditional_t<std::is_same_v<T, bool>, std::int64_t, T>(v));
  };
}

auto reading(hid_t file) {
  return [file](const char* name, auto& v, bool newer = false) {
    using T = std::remove_reference_t<decltype(v)>;
    using Stored = std::conditional_t<std::is_same_v<T, bool>, std::int64_t, T>;
    if (!newer || h5::has_attribute(file, name))
      v = static_cast<T>(h5::read_number<Stored>(file, name));
  };
}

StepHistory read_steps(hid_t file) {
  StepHistory s;
  for_each_step(s, reading(file));
  s.updates = h5::read_numbers<std::int64_t>(file, "step_updates");
  if (s.level < 0 || s.level >= std::int64_t(s.updates.size()))
    throw h5::Failure("a level of the step that cannot be");
  return s;
}

/// Format 2 has the counts in attributes.
StoredField counts_of_format_2(hid_t file) {
  StoredField f{"counts", false, 4, std::vector<double>(4)};
  const auto count = [&](const char* name) {
    return double(h5::read_number<std::int64_t>(file, name));
  };
  f.values[0] = count("fast");
  f.values[1] = count("rounds");
  if (h5::has_attribute(file, "unresolved")) f.values[2] = count("unresolved");
  if (h5::has_attribute(file, "way_squared"))
    f.values[3] = h5::read_number<double>(file, "way_squared");
  return f;
}

void write_file(const std::string& path, const SavedRun& saved, const GiveState& pieces) {
  const h5::Properties access = h5::writer_access();
  ::unlink(path.c_str());  // what a killed run has left; whatever is there is not followed
  h5::File file(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access));
  try {
    SavedRun split;  // without rows
    if (pieces)
      write_pieces(file, pieces, saved.particles, (split = saved).state);
    else
      write_state(file, saved.state);
    const SavedRun& s = pieces ? split : saved;
    h5::write_number(file, "format_version", kFormat);
    h5::write_text(file, "precision", word(s.state.precision));
    for_each_number(s, writing(file));
    if (s.released) h5::write_number(file, "released_energy", *s.released);
    if (s.steps) {
      for_each_step(*s.steps, writing(file));
      h5::write_numbers(file, "step_updates", s.steps->updates.data(), s.steps->updates.size());
    }
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

SavedRun read_file(const std::string& path, bool rows) {
  require_own_file(path);
  const h5::Reading file(path);
  const auto format = h5::read_number<std::int64_t>(file, "format_version");
  if (format < kOldestFormat || format > kFormat)
    throw h5::Failure("format version " + std::to_string(format) +
                      "; this program reads versions " + std::to_string(kOldestFormat) + " to " +
                      std::to_string(kFormat));
  SavedRun s;
  const std::string precision = h5::read_text(file, "precision");
  if (!named<Precision>(precision)) throw h5::Failure("no precision \"" + precision + "\"");
  s.state.precision = *named<Precision>(precision);
  for_each_number(s, reading(file));
  // Files written before there were levels hold neither.
  if (!h5::has_attribute(file, "steps")) s.state.steps = s.state.updates;
  if (h5::has_attribute(file, "step_level")) s.steps = read_steps(file);
  if (h5::has_attribute(file, "released_energy"))
    s.released = h5::read_number<double>(file, "released_energy");
  if (h5::has_attribute(file, "scene_sha256")) {
    s.scene = h5::read_text(file, "resolved_scene");
    s.files = h5::read_text(file, "scene_files");
    if (h5::read_text(file, "scene_sha256") != scene_digest(s.scene, s.files))
      throw h5::Failure("its scene is not the one that it was written with (SHA-256 differs)");
  }
  if (s.particles < 0 || s.particles > 2147483647 || s.state.updates < 0)
    throw h5::Failure("a number of particles or updates that cannot be");
  if (rows)
    read_state(file, s.particles, s.state);
  else
    read_head(file, s.particles, s.state), s.path = path;
  if (format == 2) s.state.fields.push_back(counts_of_format_2(file));
  if (rows && !fits(s.state, s.particles, true))
    throw h5::Failure("dataset id has negative numbers, or some of them twice");
  return s;
}

/// As anything, a link that leads nowhere or to itself too.
bool is_there(const std::string& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

/// In a process of its own first: HDF5 may crash on what is damaged. Failure.
SavedRun try_and_read(const std::string& path, bool rows) {
  try {
    if (not_regular(path).empty()) h5::trial(path, [&] { read_file(path, rows); });
  } catch (const Error& e) {
    throw h5::Failure(e.what());
  }
  return read_file(path, rows);
}

void rename_or_fail(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) throw h5::Failure(std::strerror(errno));
}

}  // namespace

void write_checkpoint(const std::string& folder, const SavedRun& saved, const GiveState& pieces) {
  const std::string path = folder + "/checkpoint.h5", temporary = path + ".tmp";
  try {
    {
      const h5::Lock lock;
      write_file(temporary, saved, pieces);
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

std::optional<SavedRun> read_checkpoint(const std::string& folder, std::vector<std::string>& notes,
                                        bool rows) {
  std::string damaged;
  for (const char* name : {"checkpoint.h5", "checkpoint_prev.h5"}) {
    const std::string path = folder + "/" + name;
    if (!is_there(path)) continue;
    try {
      SavedRun saved = try_and_read(path, rows);
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

}  // namespace pbf::io_module
