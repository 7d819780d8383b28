// EGL without a window: Mesa's surfaceless platform, or one of the devices that EGL lists (this is
// how NVIDIA's driver renders on a node without a display).
#include <fmt/core.h>
#include <array>
#include <cstdint>
#include <string>

#include "lib/base/error.h"
#include "lib/render/gl_context.h"

namespace pbf::render_module {
namespace {

// Types and values of EGL/egl.h and EGL/eglext.h.
using Display = void*;
using Config = void*;
using Context = void*;
using Surface = void*;
using Device = void*;
using Int = std::int32_t;
using Bool = std::uint32_t;
using Enum = std::uint32_t;
constexpr Int kNone = 0x3038, kExtensions = 0x3055, kSurfaceType = 0x3033;
constexpr Int kRenderableType = 0x3040, kOpenglBit = 0x0008;
constexpr Int kMajor = 0x3098, kMinor = 0x30FB, kProfileMask = 0x30FD, kCoreProfile = 0x1;
constexpr Enum kOpenglApi = 0x30A2, kPlatformSurfaceless = 0x31DD, kPlatformDevice = 0x313F;

struct Egl {
  void* (*GetProcAddress)(const char*) = nullptr;
  const char* (*QueryString)(Display, Int) = nullptr;
  Bool (*Initialize)(Display, Int*, Int*) = nullptr;
  Bool (*BindAPI)(Enum) = nullptr;
  Bool (*ChooseConfig)(Display, const Int*, Config*, Int, Int*) = nullptr;
  Context (*CreateContext)(Display, Config, Context, const Int*) = nullptr;
  Bool (*DestroyContext)(Display, Context) = nullptr;
  Bool (*MakeCurrent)(Display, Surface, Surface, Context) = nullptr;
  Int (*GetError)() = nullptr;
  Display (*GetPlatformDisplay)(Enum, void*, const Int*) = nullptr;  // EGL_EXT_platform_base
  Bool (*QueryDevices)(Int, Device*, Int*) = nullptr;                // EGL_EXT_device_enumeration

  bool load(void* library) {
    const auto get = [&](auto& f, const char* name) {
      return render_module::load(library, f, name);
    };
    if (!(get(GetProcAddress, "eglGetProcAddress") && get(QueryString, "eglQueryString") &&
          get(Initialize, "eglInitialize") && get(BindAPI, "eglBindAPI") &&
          get(ChooseConfig, "eglChooseConfig") && get(CreateContext, "eglCreateContext") &&
          get(DestroyContext, "eglDestroyContext") && get(MakeCurrent, "eglMakeCurrent") &&
          get(GetError, "eglGetError")))
      return false;
    GetPlatformDisplay =
        reinterpret_cast<decltype(GetPlatformDisplay)>(GetProcAddress("eglGetPlatformDisplayEXT"));
    QueryDevices = reinterpret_cast<decltype(QueryDevices)>(GetProcAddress("eglQueryDevicesEXT"));
    return GetPlatformDisplay != nullptr;
  }
};

struct EglPlatform final : GlPlatform {
  Egl egl;
  Display display = nullptr;
  Context context = nullptr;

  // The display is not terminated: EGL shares it with every other context of the process.
  ~EglPlatform() override { egl.DestroyContext(display, context); }
  void make_current() override {
    if (!egl.MakeCurrent(display, nullptr, nullptr, context))
      throw Error(ExitCode::unavailable, "EGL: eglMakeCurrent failed");
  }
  void release() override {
    egl.BindAPI(kOpenglApi);  // per thread; decides which API's context is released
    egl.MakeCurrent(display, nullptr, nullptr, nullptr);
  }
  void* function(const char* name) const override { return egl.GetProcAddress(name); }
};

/// A context on one display. Throws NoPlatform with the reason, and nothing in front of it.
std::unique_ptr<GlPlatform> context_on(const Egl& egl, Display display) {
  const auto require = [&egl](bool good, const char* what) {
    if (!good)
      throw NoPlatform(
          fmt::format("{} failed (EGL error 0x{:x})", what, static_cast<unsigned>(egl.GetError())));
  };
  Int major = 0, minor = 0, configs = 0;
  require(display && egl.Initialize(display, &major, &minor), "eglInitialize");
  Config config = nullptr;
  constexpr std::array config_wanted{kRenderableType, kOpenglBit, kSurfaceType, 0, kNone};
  constexpr std::array context_wanted{kMajor, 3, kMinor, 3, kProfileMask, kCoreProfile, kNone};
  require(egl.BindAPI(kOpenglApi) &&
              egl.ChooseConfig(display, config_wanted.data(), &config, 1, &configs) && configs >= 1,
          "finding a configuration for OpenGL");
  Context context = egl.CreateContext(display, config, nullptr, context_wanted.data());
  require(context, "eglCreateContext for OpenGL 3.3 core");
  auto platform = std::make_unique<EglPlatform>();
  platform->egl = egl;
  platform->display = display;
  platform->context = context;
  return platform;
}

}  // namespace

std::unique_ptr<GlPlatform> open_egl(const std::vector<std::string>& libraries, bool device) {
  void* library = open_library(libraries);
  const auto fail = [device](const std::string& why) {
    throw NoPlatform((device ? "\n  EGL device: " : "\n  EGL surfaceless: ") + why);
  };
  Egl egl;
  if (!egl.load(library)) fail("the library lacks EGL_EXT_platform_base");
  if (!device) {
    const char* extensions = egl.QueryString(nullptr, kExtensions);
    if (!extensions ||
        std::string(extensions).find("EGL_MESA_platform_surfaceless") == std::string::npos)
      fail("the platform is not there (Mesa's EGL driver is not installed)");
    try {
      return context_on(egl, egl.GetPlatformDisplay(kPlatformSurfaceless, nullptr, nullptr));
    } catch (const NoPlatform& e) {
      fail(e.what());
    }
  }
  std::array<Device, 32> devices{};
  Int count = 0;
  if (!egl.QueryDevices ||
      !egl.QueryDevices(static_cast<Int>(devices.size()), devices.data(), &count))
    fail("the library cannot list devices");
  std::string why = "no device";
  for (Int i = 0; i < count; ++i) {
    try {
      return context_on(egl, egl.GetPlatformDisplay(kPlatformDevice,
                                                    devices[static_cast<std::size_t>(i)], nullptr));
    } catch (const NoPlatform& e) {
      why = e.what();
    }
  }
  fail(std::to_string(count) + " listed; " + why);
  return nullptr;
}

}  // namespace pbf::render_module
