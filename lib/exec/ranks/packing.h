// Bytes of what ranks send to each other. All ranks run the same program on equal machines.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "lib/base/error.h"

namespace pbf::exec_module {

class Packer {
 public:
  template <class T>
  Packer& add(const T& t) requires std::is_trivially_copyable_v<T> {
    return append(&t, sizeof t);
  }
  template <class T>
  Packer& add(const std::vector<T>& all) requires std::is_trivially_copyable_v<T> {
    add(all.size());
    return append(all.data(), all.size() * sizeof(T));
  }
  Packer& add(const std::string& text) {
    add(text.size());
    return append(text.data(), text.size());
  }
  Packer& add(const std::vector<std::string>& all) {
    add(all.size());
    for (const std::string& text : all) add(text);
    return *this;
  }
  std::vector<char> bytes{};

 private:
  Packer& append(const void* from, std::size_t n) {
    const char* at = static_cast<const char*>(from);
    bytes.insert(bytes.end(), at, at + n);
    return *this;
  }
};

/// Throws Error(internal) if the bytes end too early.
class Unpacker {
 public:
  explicit Unpacker(const std::vector<char>& bytes) : bytes_(bytes) {}
  template <class T>
  void take(T& t) requires std::is_trivially_copyable_v<T> {
    copy(&t, sizeof t);
  }
  template <class T>
  void take(std::vector<T>& all) requires std::is_trivially_copyable_v<T> {
    all.resize(next(sizeof(T)));
    copy(all.data(), all.size() * sizeof(T));
  }
  void take(std::string& text) {
    text.resize(next(1));
    copy(text.data(), text.size());
  }
  void take(std::vector<std::string>& all) {
    all.resize(next(1));
    for (std::string& text : all) take(text);
  }
  template <class T>
  T take() {
    T t{};
    take(t);
    return t;
  }

 private:
  /// A number of items of at least `each` bytes, which must be there.
  std::size_t next(std::size_t each) {
    std::size_t n = 0;
    take(n);
    if (n > (bytes_.size() - at_) / each)
      throw Error(ExitCode::internal, "a message between ranks ends too early");
    return n;
  }
  void copy(void* to, std::size_t n) {
    if (n > bytes_.size() - at_)
      throw Error(ExitCode::internal, "a message between ranks ends too early");
    if (n) std::memcpy(to, bytes_.data() + at_, n);
    at_ += n;
  }
  const std::vector<char>& bytes_;
  std::size_t at_ = 0;
};

}  // namespace pbf::exec_module
