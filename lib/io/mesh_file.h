// Meshes: files of triangles.
#pragma once

#include <string>

#include "lib/scene/triangle_mesh.h"

namespace pbf::io_module {

/// Reads STL, binary or ASCII, or Wavefront OBJ, known by their contents. Corners with equal
/// coordinates become one vertex. Faces of OBJ with more than three corners are divided into
/// triangles from their first corner on. Triangles with two equal corners are left out. Normals,
/// textures, groups and materials are passed over.
/// sha256: gets that of the bytes that were read, if given.
/// Throws Error(io) when the file cannot be read or is no regular file; Error(bad_input) naming
/// file and line, or triangle, when it cannot be understood or a coordinate is not finite;
/// Error(unavailable) when it does not fit into the available memory.
TriangleMesh read_mesh_file(const std::string& path, std::string* sha256 = nullptr);

/// The same from the bytes of a file; `name` begins messages.
TriangleMesh read_mesh(const std::string& bytes, const std::string& name);

}  // namespace pbf::io_module
