// OSMesa: Mesa's software rasteriser without any window system (Mesa removed it in 25.1).
#include <dlfcn.h>

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
using CreateContext = Context (*)(const int*, Context);
using DestroyContext = void (*)(Context);
using MakeCurrent = gl::Bool (*)(Context, void*, gl::Enum, gl::Size, gl::Size);
using GetProc = void* (*)(const char*);

struct OsmesaPlatform final : GlPlatform {
  DestroyContext destroy_context = nullptr;
  MakeCurrent make_context_current = nullptr;
  GetProc get_proc = nullptr;
  Context context = nullptr;
  std::array<std::uint32_t, 16> window{};  // OSMesa wants a default framebuffer; it stays unused

  ~OsmesaPlatform() override { destroy_context(context); }
  void make_current() override {
    if (!make_context_current(context, window.data(), gl::UNSIGNED_BYTE, 4, 4))
      throw Error(ExitCode::unavailable, "OSMesa: OSMesaMakeCurrent failed");
  }
  void release() override { make_context_current(nullptr, nullptr, 0, 0, 0); }
  void* function(const char* name) const override { return get_proc(name); }
};

}  // namespace

std::unique_ptr<GlPlatform> open_osmesa(const std::vector<std::string>& libraries,
                                        std::string& tried) {
  void* library = open_library(libraries, tried);
  if (!library) return nullptr;
  const auto create = reinterpret_cast<CreateContext>(dlsym(library, "OSMesaCreateContextAttribs"));
  auto platform = std::make_unique<OsmesaPlatform>();
  platform->destroy_context =
      reinterpret_cast<DestroyContext>(dlsym(library, "OSMesaDestroyContext"));
  platform->make_context_current =
      reinterpret_cast<MakeCurrent>(dlsym(library, "OSMesaMakeCurrent"));
  platform->get_proc = reinterpret_cast<GetProc>(dlsym(library, "OSMesaGetProcAddress"));
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
  if (create && platform->destroy_context && platform->make_context_current && platform->get_proc)
    platform->context = create(attributes.data(), nullptr);
  if (platform->context) return platform;
  platform->destroy_context = [](Context) {};  // nothing to destroy
  tried += "\n  OSMesa: the library gives no OpenGL 3.3 core context";
  return nullptr;
}

}  // namespace pbf::inline render_module
