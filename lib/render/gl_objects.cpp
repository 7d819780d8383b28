#include "lib/render/gl_objects.h"

#include <fmt/core.h>
#include <array>

#include "lib/base/error.h"
#include "pbf_shaders.h"

namespace pbf::render_module::gl {
namespace {

template <class GetInt, class GetLog>
void check_built(Uint name, Enum status, GetInt get, GetLog log, const char* what) {
  Int good = 0;
  get(name, status, &good);
  if (good) return;
  std::array<Char, 2000> text{};
  log(name, static_cast<Size>(text.size() - 1), nullptr, text.data());
  throw Error(ExitCode::unavailable,
              std::string("the OpenGL driver refuses ") + what + ": " + text.data());
}

Uint compiled(const Table& gl, Enum type, const char* library, const char* body) {
  const Uint shader = gl.CreateShader(type);
  const std::array<const Char*, 3> text{shaders::head, library, body};
  gl.ShaderSource(shader, 3, text.data(), nullptr);
  gl.CompileShader(shader);
  check_built(shader, COMPILE_STATUS, gl.GetShaderiv, gl.GetShaderInfoLog, "a shader");
  return shader;
}

}  // namespace

Program::Program(const Table& gl, const char* vertex, const char* fragment, const char* library)
    : gl_(gl), name_(gl.CreateProgram()) {
  const auto attach = [&](Uint shader) {
    gl.AttachShader(name_, shader);
    gl.DeleteShader(shader);  // lives on while attached
  };
  attach(compiled(gl, VERTEX_SHADER, "", vertex));
  attach(compiled(gl, FRAGMENT_SHADER, library, fragment));
  gl.LinkProgram(name_);
  check_built(name_, LINK_STATUS, gl.GetProgramiv, gl.GetProgramInfoLog, "a program");
}

Buffer::Buffer(const Table& gl, Size stride, std::initializer_list<Attribute> attributes,
               Uint divisor)
    : gl_(gl) {
  gl.GenVertexArrays(1, &array_);
  gl.GenBuffers(1, &buffer_);
  gl.BindVertexArray(array_);
  gl.BindBuffer(ARRAY_BUFFER, buffer_);
  Uint location = 0;
  for (const auto& a : attributes) {
    gl.EnableVertexAttribArray(location);
    gl.VertexAttribPointer(location, a.components, a.type, a.normalized, stride,
                           reinterpret_cast<const void*>(a.offset));
    gl.VertexAttribDivisor(location, divisor);
    ++location;
  }
}

Buffer::~Buffer() {
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteBuffers(1, &buffer_);
}

void Buffer::fill(const void* data, std::size_t bytes) const {
  gl_.BindBuffer(ARRAY_BUFFER, buffer_);
  gl_.BufferData(ARRAY_BUFFER, static_cast<std::ptrdiff_t>(bytes), data, STREAM_DRAW);
}

Texture::Texture(const Table& gl, Size width, Size height, const Format& format, const void* data)
    : gl_(gl) {
  gl.GenTextures(1, &name_);
  gl.BindTexture(TEXTURE_2D, name_);
  gl.TexImage2D(TEXTURE_2D, 0, static_cast<Int>(format.internal), width, height, 0, format.layout,
                format.type, data);
  gl.TexParameteri(TEXTURE_2D, TEXTURE_MIN_FILTER, NEAREST);
  gl.TexParameteri(TEXTURE_2D, TEXTURE_MAG_FILTER, NEAREST);
  gl.TexParameteri(TEXTURE_2D, TEXTURE_WRAP_S, CLAMP_TO_EDGE);
  gl.TexParameteri(TEXTURE_2D, TEXTURE_WRAP_T, CLAMP_TO_EDGE);
}

void Texture::compare_linearly() const {
  gl_.BindTexture(TEXTURE_2D, name_);
  gl_.TexParameteri(TEXTURE_2D, TEXTURE_MIN_FILTER, LINEAR);
  gl_.TexParameteri(TEXTURE_2D, TEXTURE_MAG_FILTER, LINEAR);
  gl_.TexParameteri(TEXTURE_2D, TEXTURE_COMPARE_MODE, COMPARE_REF_TO_TEXTURE);
}

void Texture::bind(const Program& program, const char* name, Uint unit) const {
  gl_.ActiveTexture(TEXTURE0 + unit);
  gl_.BindTexture(TEXTURE_2D, name_);
  program.set_int(name, static_cast<Int>(unit));
}

Target::Target(const Table& gl, Size width, Size height, const Format& color, Depth depth)
    : gl_(gl), width_(width), height_(height) {
  gl.GenFramebuffers(1, &frame_);
  gl.BindFramebuffer(FRAMEBUFFER, frame_);
  const auto attach = [&](std::optional<Texture>& texture, const Format& format, Enum point) {
    texture.emplace(gl, width, height, format);
    gl.FramebufferTexture2D(FRAMEBUFFER, point, TEXTURE_2D, texture->name(), 0);
  };
  if (depth != Depth::alone) {
    attach(color_, color, COLOR_ATTACHMENT0);
  } else {  // OpenGL 3.3 calls a framebuffer incomplete when it would draw a colour it has not
    gl.DrawBuffer(NONE);
    gl.ReadBuffer(NONE);
  }
  if (depth != Depth::without) attach(depth_, kDepth32, DEPTH_ATTACHMENT);
  const Enum state = gl.CheckFramebufferStatus(FRAMEBUFFER);
  if (state != FRAMEBUFFER_COMPLETE || gl.GetError() != NO_ERROR)
    throw Error(
        ExitCode::unavailable,
        fmt::format(
            "the OpenGL driver gives no picture of {} x {} samples; choose a smaller render.size",
            width, height));
}

Target::~Target() { gl_.DeleteFramebuffers(1, &frame_); }

void Target::draw_into() const {
  gl_.BindFramebuffer(FRAMEBUFFER, frame_);
  gl_.Viewport(0, 0, width_, height_);
}

}  // namespace pbf::render_module::gl
