// Whether a file is HDF5, from its first bytes.
#pragma once

#include <istream>
#include <string_view>

namespace pbf::inline io_module::h5 {

/// Whether the first 8 bytes of a file are HDF5's signature.
bool is_signature(std::string_view head);

/// Whether a stream begins with HDF5's signature; reads 8 bytes.
bool begins_as_hdf5(std::istream& in);

}  // namespace pbf::inline io_module::h5
