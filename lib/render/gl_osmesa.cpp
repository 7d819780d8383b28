// OSMesa: Mesa's software rasteriser without any window system (Mesa removed it in 25.1).
#include <array>
#include <cstdint>

#include "lib/base/error.h"
#include "lib/render/gl_platform.h"
#include "lib/render/gl_table.h"

namespace pbf::inline render_module {
namespace {

// Values of GL/osmesa.h.
constexpr int kFormat = 0x22, kDepthBits = 0x30, kStencilBits = 0x31, kAccumBits = 0x32;
constexpr int kProfile = 0x33, kCoreProfile = 0x34, kMajor = 0x36, kMinor = 0x37;

using Context = void*;

struct OsmesaPlatform final : GlPlatform {
  Context (*create_context)(const int*, Context) = nullptr;
  void (*destroy_context)(Context) = nullptr;
  gl::Bool (*make_context_current)(Context, void*, gl::Enum, gl::Size, gl::Size) = nullptr;
  void* (*get_proc)(const char*) = nullptr;
  Context context = nullptr;
  std::array<std::uint32_t, 16> window{};  // OSMesa wants a default framebuffer; it stays unused

  ~OsmesaPlatform() override {
    if (context) destroy_context(context);
  }
  void make_current() override {
    if (!make_context_current(context, window.data(), gl::UNSIGNED_BYTE, 4, 4))
      throw Error(ExitCode::unavailable, "OSMesa: OSMesaMakeCurrent failed");
  }
  void release() override { make_context_current(nullptr, nullptr, 0, 0, 0); }
  void* function(const char* name) const override { return get_proc(name); }
};

}  // namespace

std::unique_ptr<GlPlatform> open_osmesa(const std::vector<std::string>& libraries) {
  void* library = open_library(libraries);
  auto platform = std::make_unique<OsmesaPlatform>();
  const bool complete = load(library, platform->create_context, "OSMesaCreateContextAttribs") &&
                        load(library, platform->destroy_context, "OSMesaDestroyContext") &&
                        load(library, platform->make_context_current, "OSMesaMakeCurrent") &&
                        load(library, platform->get_proc, "OSMesaGetProcAddress");
  constexpr std::array attributes{kFormat,
                                  static_cast<int>(gl::RGBA),
                                  kDepthBits,
                                  0,
                                  kStencilBits,
                                  0,
                                  kAccumBits,
                                  0,
                                  kProfile,
                                  kCoreProfile,
                                  kMajor,
                                  3,
                                  kMinor,
                                  3,
                                  0};
  if (complete) platform->context = platform->create_context(attributes.data(), nullptr);
  if (platform->context) return platform;
  throw NoPlatform("\n  OSMesa: the library gives no OpenGL 3.3 core context");
}

}  // namespace pbf::inline render_module
