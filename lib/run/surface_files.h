// Reads the surfaces of obstacles from files.
#pragma once

#include <memory>
#include <string>

#include "lib/scene/scene.h"
#include "lib/scene/solid_mesh.h"

namespace pbf::run_module {

/// A mesh (lib/io/mesh_file.h). key: begins messages. Throws what read_mesh_file() and
/// require_closed() throw.
std::shared_ptr<const SolidMesh> read_surface(const std::string& key, const std::string& file);

/// The solid below the heights of a grid: a CSV file with the header x,y,z, in m, rows in any
/// order, which are moved by `translate`. The grid must cover the domain; beyond it, the outer
/// heights go on for a few smoothing lengths. Throws what read_particle_file() throws, and
/// Error(bad_input) for a grid with gaps, or too small.
std::shared_ptr<const SolidMesh> read_heights(const Scene& scene, const Double3& translate,
                                              const std::string& key, const std::string& file);

}  // namespace pbf::run_module
