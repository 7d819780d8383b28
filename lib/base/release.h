#pragma once

#include <vector>

namespace pbf::base_module {

/// Empties a vector and gives its memory back (`= {}` would keep it).
template <class T>
void release(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

}  // namespace pbf::base_module
