// Tells from the first bytes whether a file is HDF5.
#pragma once

#include <istream>
#include <string_view>

namespace pbf::io_module::h5 {

/// Whether the first 8 bytes of a file are HDF5's signature.
inline bool is_signature(std::string_view head) { return head == "\x89HDF\r\n\x1a\n"; }

/// Whether a stream begins with HDF5's signature; reads 8 bytes.
inline bool begins_as_hdf5(std::istream& in) {
  char head[8] = {};
  in.read(head, sizeof head);
  return is_signature({head, static_cast<std::size_t>(in.gcount())});
}

}  // namespace pbf::io_module::h5
