// Owners of OpenGL objects. Made and destroyed while their context is current.
#pragma once

#include <array>
#include <initializer_list>
#include <string>
#include <utility>

#include "lib/render/gl_table.h"

namespace pbf::inline render_module::gl {

/// A linked program. Throws Error(unavailable) with the driver's message when it does not build.
class Program {
 public:
  Program(const Table& gl, const char* vertex, const char* fragment);
  ~Program() { gl_.DeleteProgram(name_); }
  Program(const Program&) = delete;
  void use() const { gl_.UseProgram(name_); }
  Int uniform(const char* name) const { return gl_.GetUniformLocation(name_, name); }

 private:
  const Table& gl_;
  Uint name_;
};

/// One attribute of a vertex: location = its index in the list given to Buffer.
struct Attribute {
  Int components;
  Enum type;
  Bool normalized;
  std::size_t offset;
};

/// A vertex array over one buffer that is filled anew for every picture.
class Buffer {
 public:
  /// `divisor` 1: one row per instance; 0: one row per vertex.
  Buffer(const Table& gl, Size stride, std::initializer_list<Attribute> attributes, Uint divisor);
  ~Buffer();
  Buffer(const Buffer&) = delete;
  void fill(const void* data, std::size_t bytes) const;
  void bind() const { gl_.BindVertexArray(array_); }

 private:
  const Table& gl_;
  Uint array_ = 0, buffer_ = 0;
};

/// A framebuffer with an RGBA8 colour texture and, on request, a float depth texture.
class Target {
 public:
  Target(const Table& gl, Size width, Size height, bool depth);
  ~Target();
  Target(const Target&) = delete;
  void draw_into() const;
  Size width() const { return width_; }
  Size height() const { return height_; }
  Uint color() const { return textures_[0]; }
  Uint depth() const { return textures_[1]; }

 private:
  const Table& gl_;
  Size width_, height_;
  Uint frame_ = 0;
  std::array<Uint, 2> textures_{};
};

}  // namespace pbf::inline render_module::gl
