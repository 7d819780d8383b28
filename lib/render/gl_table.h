// The part of OpenGL 3.3 core that the renderer uses: types, constants and a table of functions.
// Declared here so that no OpenGL header is needed to build and no GL library is linked; the
// functions come from the library's own GetProcAddress (values: Khronos OpenGL registry).
#pragma once

#include <cstddef>
#include <cstdint>

namespace pbf::render_module::gl {

using Enum = std::uint32_t;
using Uint = std::uint32_t;
using Bits = std::uint32_t;
using Int = std::int32_t;
using Size = std::int32_t;
using Bool = std::uint8_t;
using Char = char;
using Ubyte = std::uint8_t;

inline constexpr Enum RENDERER = 0x1F01;
inline constexpr Enum NO_ERROR = 0, OUT_OF_MEMORY = 0x0505;
inline constexpr Enum TRIANGLES = 0x0004, TRIANGLE_STRIP = 0x0005;
inline constexpr Bits DEPTH_BUFFER_BIT = 0x0100, COLOR_BUFFER_BIT = 0x4000;
inline constexpr Enum LEQUAL = 0x0203, DEPTH_TEST = 0x0B71;
inline constexpr Enum BLEND = 0x0BE2, ONE = 1, NONE = 0;
inline constexpr Enum UNSIGNED_BYTE = 0x1401, FLOAT = 0x1406;
inline constexpr Enum RGBA = 0x1908, RGBA8 = 0x8058, DEPTH_COMPONENT = 0x1902;
inline constexpr Enum DEPTH_COMPONENT32F = 0x8CAC;
inline constexpr Enum RG = 0x8227, RG16F = 0x822F, RG32F = 0x8230;
inline constexpr Enum PACK_ALIGNMENT = 0x0D05, MAX_TEXTURE_SIZE = 0x0D33;
inline constexpr Enum MAX_VIEWPORT_DIMS = 0x0D3A;
inline constexpr Enum TEXTURE_2D = 0x0DE1, TEXTURE0 = 0x84C0;
inline constexpr Enum TEXTURE_MAG_FILTER = 0x2800, TEXTURE_MIN_FILTER = 0x2801;
inline constexpr Int NEAREST = 0x2600, LINEAR = 0x2601;
inline constexpr Enum TEXTURE_WRAP_S = 0x2802, TEXTURE_WRAP_T = 0x2803;
inline constexpr Int CLAMP_TO_EDGE = 0x812F;
inline constexpr Enum TEXTURE_COMPARE_MODE = 0x884C;
inline constexpr Int COMPARE_REF_TO_TEXTURE = 0x884E;
inline constexpr Enum ARRAY_BUFFER = 0x8892, STREAM_DRAW = 0x88E0;
inline constexpr Enum FRAGMENT_SHADER = 0x8B30, VERTEX_SHADER = 0x8B31;
inline constexpr Enum COMPILE_STATUS = 0x8B81, LINK_STATUS = 0x8B82;
inline constexpr Enum FRAMEBUFFER = 0x8D40, FRAMEBUFFER_COMPLETE = 0x8CD5;
inline constexpr Enum COLOR_ATTACHMENT0 = 0x8CE0, DEPTH_ATTACHMENT = 0x8D00;

// X(result, name without "gl", parameters)
#define PBF_GL_FUNCTIONS(X)                                                       \
  X(const Ubyte*, GetString, (Enum))                                              \
  X(Enum, GetError, ())                                                           \
  X(void, GetIntegerv, (Enum, Int*))                                              \
  X(void, Enable, (Enum))                                                         \
  X(void, Disable, (Enum))                                                        \
  X(void, DepthFunc, (Enum))                                                      \
  X(void, BlendFunc, (Enum, Enum))                                                \
  X(void, DrawBuffer, (Enum))                                                     \
  X(void, ReadBuffer, (Enum))                                                     \
  X(void, Viewport, (Int, Int, Size, Size))                                       \
  X(void, Clear, (Bits))                                                          \
  X(void, PixelStorei, (Enum, Int))                                               \
  X(void, ReadPixels, (Int, Int, Size, Size, Enum, Enum, void*))                  \
  X(Uint, CreateShader, (Enum))                                                   \
  X(void, ShaderSource, (Uint, Size, const Char* const*, const Int*))             \
  X(void, CompileShader, (Uint))                                                  \
  X(void, GetShaderiv, (Uint, Enum, Int*))                                        \
  X(void, GetShaderInfoLog, (Uint, Size, Size*, Char*))                           \
  X(void, DeleteShader, (Uint))                                                   \
  X(Uint, CreateProgram, ())                                                      \
  X(void, AttachShader, (Uint, Uint))                                             \
  X(void, LinkProgram, (Uint))                                                    \
  X(void, GetProgramiv, (Uint, Enum, Int*))                                       \
  X(void, GetProgramInfoLog, (Uint, Size, Size*, Char*))                          \
  X(void, DeleteProgram, (Uint))                                                  \
  X(void, UseProgram, (Uint))                                                     \
  X(Int, GetUniformLocation, (Uint, const Char*))                                 \
  X(void, Uniform1i, (Int, Int))                                                  \
  X(void, Uniform1f, (Int, float))                                                \
  X(void, Uniform2f, (Int, float, float))                                         \
  X(void, Uniform4f, (Int, float, float, float, float))                           \
  X(void, GenVertexArrays, (Size, Uint*))                                         \
  X(void, BindVertexArray, (Uint))                                                \
  X(void, DeleteVertexArrays, (Size, const Uint*))                                \
  X(void, GenBuffers, (Size, Uint*))                                              \
  X(void, BindBuffer, (Enum, Uint))                                               \
  X(void, BufferData, (Enum, std::ptrdiff_t, const void*, Enum))                  \
  X(void, DeleteBuffers, (Size, const Uint*))                                     \
  X(void, EnableVertexAttribArray, (Uint))                                        \
  X(void, VertexAttribPointer, (Uint, Int, Enum, Bool, Size, const void*))        \
  X(void, VertexAttribDivisor, (Uint, Uint))                                      \
  X(void, DrawArrays, (Enum, Int, Size))                                          \
  X(void, DrawArraysInstanced, (Enum, Int, Size, Size))                           \
  X(void, GenTextures, (Size, Uint*))                                             \
  X(void, BindTexture, (Enum, Uint))                                              \
  X(void, ActiveTexture, (Enum))                                                  \
  X(void, TexImage2D, (Enum, Int, Int, Size, Size, Int, Enum, Enum, const void*)) \
  X(void, TexParameteri, (Enum, Enum, Int))                                       \
  X(void, DeleteTextures, (Size, const Uint*))                                    \
  X(void, GenFramebuffers, (Size, Uint*))                                         \
  X(void, BindFramebuffer, (Enum, Uint))                                          \
  X(void, FramebufferTexture2D, (Enum, Enum, Enum, Uint, Int))                    \
  X(Enum, CheckFramebufferStatus, (Enum))                                         \
  X(void, DeleteFramebuffers, (Size, const Uint*))

/// Pointers to the functions above; valid while the context that filled them is current.
struct Table {
#define PBF_GL_MEMBER(result, name, parameters) result(*name) parameters = nullptr;
  PBF_GL_FUNCTIONS(PBF_GL_MEMBER)
#undef PBF_GL_MEMBER
};

}  // namespace pbf::render_module::gl
