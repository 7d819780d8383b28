// Owners of OpenGL objects. Made and destroyed while their context is current.
#pragma once

#include <array>
#include <initializer_list>
#include <optional>

#include "lib/render/gl_table.h"

namespace pbf::render_module::gl {

/// A linked program. Throws Error(unavailable) with the driver's message when it does not build.
class Program {
 public:
  /// `library`: stands before `fragment`.
  Program(const Table& gl, const char* vertex, const char* fragment, const char* library = "");
  ~Program() { gl_.DeleteProgram(name_); }
  Program(const Program&) = delete;
  void use() const { gl_.UseProgram(name_); }
  // Uniforms of the program, which is in use.
  void set_int(const char* name, Int i) const { gl_.Uniform1i(at(name), i); }
  void set(const char* name, double x) const { gl_.Uniform1f(at(name), float(x)); }
  void set(const char* name, double x, double y) const {
    gl_.Uniform2f(at(name), float(x), float(y));
  }
  void set(const char* name, const std::array<double, 3>& v, double w = 0) const {
    gl_.Uniform4f(at(name), float(v[0]), float(v[1]), float(v[2]), float(w));
  }

 private:
  Int at(const char* name) const { return gl_.GetUniformLocation(name_, name); }

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
  /// Fills it with the rows of `corners`, three to a triangle, and draws them.
  void draw_triangles(const auto& corners) const {
    bind();
    fill(corners.data(), corners.size() * sizeof(corners[0]));
    gl_.DrawArrays(TRIANGLES, 0, static_cast<Size>(corners.size()));
  }

 private:
  const Table& gl_;
  Uint array_ = 0, buffer_ = 0;
};

/// What a texel holds: the internal format of OpenGL, and that of the bytes it is filled with.
struct Format {
  Enum internal, layout, type;
};
inline constexpr Format kColor8{RGBA8, RGBA, UNSIGNED_BYTE}, kPair32{RG32F, RG, FLOAT},
    kSums16{RG16F, RG, FLOAT}, kDepth32{DEPTH_COMPONENT32F, DEPTH_COMPONENT, FLOAT};

/// A texture of one level, read texel by texel unless set otherwise.
class Texture {
 public:
  /// `data`: texels from the lowest row on, or null.
  Texture(const Table& gl, Size width, Size height, const Format& format,
          const void* data = nullptr);
  ~Texture() { gl_.DeleteTextures(1, &name_); }
  Texture(const Texture&) = delete;
  Uint name() const { return name_; }
  /// For a sampler2DShadow: the share of the four texels around a place that are not nearer.
  void compare_linearly() const;
  /// Makes it the texture of unit `unit` and of the sampler `name` of `program`, which is in use.
  void bind(const Program& program, const char* name, Uint unit) const;

 private:
  const Table& gl_;
  Uint name_ = 0;
};

/// A framebuffer with a colour texture, a float depth texture, or both.
class Target {
 public:
  enum class Depth { without, with, alone };
  Target(const Table& gl, Size width, Size height, const Format& color, Depth depth);
  ~Target();
  Target(const Target&) = delete;
  void draw_into() const;
  const Texture& color() const { return *color_; }
  const Texture& depth() const { return *depth_; }

 private:
  const Table& gl_;
  Size width_, height_;
  Uint frame_ = 0;
  std::optional<Texture> color_, depth_;
};

}  // namespace pbf::render_module::gl
