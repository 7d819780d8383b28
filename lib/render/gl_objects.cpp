#include "lib/render/gl_objects.h"

#include "lib/base/error.h"
#include "lib/render/shaders.h"

namespace pbf::inline render_module::gl {
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

Uint compiled(const Table& gl, Enum type, const char* body) {
  const Uint shader = gl.CreateShader(type);
  const std::array<const Char*, 2> text{shaders::kHead, body};
  gl.ShaderSource(shader, 2, text.data(), nullptr);
  gl.CompileShader(shader);
  check_built(shader, COMPILE_STATUS, gl.GetShaderiv, gl.GetShaderInfoLog, "a shader");
  return shader;
}

}  // namespace

Program::Program(const Table& gl, const char* vertex, const char* fragment)
    : gl_(gl), name_(gl.CreateProgram()) {
  for (const auto& [type, body] : {std::pair{VERTEX_SHADER, vertex}, {FRAGMENT_SHADER, fragment}}) {
    const Uint shader = compiled(gl, type, body);
    gl.AttachShader(name_, shader);
    gl.DeleteShader(shader);  // lives on while attached
  }
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

Target::Target(const Table& gl, Size width, Size height, bool depth)
    : gl_(gl), width_(width), height_(height) {
  gl.GenFramebuffers(1, &frame_);
  gl.BindFramebuffer(FRAMEBUFFER, frame_);
  const auto attach = [&](Uint& texture, Int format, Enum layout, Enum type, Enum point) {
    gl.GenTextures(1, &texture);
    gl.BindTexture(TEXTURE_2D, texture);
    gl.TexImage2D(TEXTURE_2D, 0, format, width, height, 0, layout, type, nullptr);
    gl.TexParameteri(TEXTURE_2D, TEXTURE_MIN_FILTER, NEAREST);
    gl.TexParameteri(TEXTURE_2D, TEXTURE_MAG_FILTER, NEAREST);
    gl.FramebufferTexture2D(FRAMEBUFFER, point, TEXTURE_2D, texture, 0);
  };
  attach(textures_[0], static_cast<Int>(RGBA8), RGBA, UNSIGNED_BYTE, COLOR_ATTACHMENT0);
  if (depth)
    attach(textures_[1], static_cast<Int>(DEPTH_COMPONENT32F), DEPTH_COMPONENT, FLOAT,
           DEPTH_ATTACHMENT);
  const Enum state = gl.CheckFramebufferStatus(FRAMEBUFFER);
  if (state != FRAMEBUFFER_COMPLETE || gl.GetError() != NO_ERROR)
    throw Error(ExitCode::unavailable, "the OpenGL driver gives no picture of " +
                                           std::to_string(width) + "x" + std::to_string(height) +
                                           " samples; choose a smaller render.size");
}

Target::~Target() {
  gl_.DeleteFramebuffers(1, &frame_);
  gl_.DeleteTextures(1, &textures_[0]);
  if (textures_[1]) gl_.DeleteTextures(1, &textures_[1]);
}

void Target::draw_into() const {
  gl_.BindFramebuffer(FRAMEBUFFER, frame_);
  gl_.Viewport(0, 0, width_, height_);
}

}  // namespace pbf::inline render_module::gl
