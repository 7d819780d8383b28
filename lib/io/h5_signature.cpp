#include "lib/io/h5_signature.h"

namespace pbf::inline io_module::h5 {

bool is_signature(std::string_view head) { return head == "\x89HDF\r\n\x1a\n"; }

bool begins_as_hdf5(std::istream& in) {
  char head[8] = {};
  in.read(head, sizeof head);
  return is_signature({head, static_cast<std::size_t>(in.gcount())});
}

}  // namespace pbf::inline io_module::h5
