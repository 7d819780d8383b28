// OSMesa: Mesa's software rasteriser without any window system (Mesa removed it in 25.1).
#include <array>
#include <cstdint>

#include "lib/base/error.h"
#include "lib/render/gl_context.h"

namespace pbf::render_module {
namespace {

// Values of GL/osmesa.h.
constexpr int kOsmesaFormat = 0x22, kOsmesaDepthBits = 0x30, kOsmesaStencilBits = 0x31,
              kOsmesaAccumBits = 0x32;
constexpr int kOsmesaProfile = 0x33, kOsmesaCoreProfile = 0x34, kOsmesaMajor = 0x36,
              kOsmesaMinor = 0x37;

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
  constexpr int attributes[][2] = {{kOsmesaFormat, int(gl::RGBA)},
                                   {kOsmesaDepthBits, 0},
                                   {kOsmesaStencilBits, 0},
                                   {kOsmesaAccumBits, 0},
                                   {kOsmesaProfile, kOsmesaCoreProfile},
                                   {kOsmesaMajor, 3},
                                   {kOsmesaMinor, 3},
                                   {0, 0}};
  if (complete) platform->context = platform->create_context(attributes[0], nullptr);
  if (platform->context) return platform;
  throw NoPlatform("\n  OSMesa: the library gives no OpenGL 3.3 core context");
}

}  // namespace pbf::render_module
