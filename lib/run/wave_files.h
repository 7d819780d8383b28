// The tables of wave makers, the files that a run keeps of them, and warnings about waves.
#pragma once

#include <string>
#include <vector>

#include "lib/run/warnings.h"

namespace pbf::run_module {

/// Fills in the tables of all wave makers of the scene, and `repeat: auto`. Throws
/// Error(bad_input) with the place of the motion for a paddle that comes out of its wall or reaches
/// the middle of the tank, a flap that turns by more than 30 degrees, and tables of more than 4
/// million rows.
void make_wave_tables(Scene& scene);

/// waves_NAME.csv of each wave maker: its table, as motions of kind `file` read it, and after it
/// the elevation expected at each level gauge ahead of it, eta_GAUGE_m. Tables have been made.
struct WaveFile {
  std::string name, text;
};
std::vector<WaveFile> wave_files(const Scene& scene);
/// Whether a file of a run folder has such a name.
bool is_wave_file(const std::string& name);

/// Warnings of kinds wave_breaks, wave_theory, wave_resolution, wave_step, wave_settings and
/// wave_returns; without text where there is nothing to say.
std::vector<Warning> wave_warnings(const Scene& scene);

}  // namespace pbf::run_module
