#include "lib/render/gl_context.h"

#include <cstdlib>

#include "lib/base/error.h"
#include "lib/base/start_thread.h"

namespace pbf::render_module {
namespace {

// llvmpipe takes its number of threads from the environment when its screen is made, and nowhere
// else; the variable is put back so that nothing started later inherits it.
struct Unset {
  void operator()(const char* name) const { unsetenv(name); }
};
std::unique_ptr<const char, Unset> limit_threads(int threads) {
  constexpr const char* kName = "LP_NUM_THREADS";
  if (threads <= 0 || std::getenv(kName)) return nullptr;
  setenv(kName, threads == 1 ? "0" : std::to_string(threads).c_str(), 0);  // beside the caller
  return std::unique_ptr<const char, Unset>(kName);
}

/// `threads`, or 1 where so many cannot be started: Mesa would wait for ever for those it lacks.
int startable(int threads) {
  constexpr int kOfMesa = 4;  // for what is not drawing
  const int wanted = threads > 0 ? threads : int(std::thread::hardware_concurrency());
  return wanted > 1 && reason_against_threads(wanted + kOfMesa) != 0 ? 1 : threads;
}

}  // namespace

void* open_library(const std::vector<std::string>& names) {
  std::string tried;
  for (const auto& name : names) {
    if (void* library = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
    tried += "\n  " + std::string(dlerror());
  }
  throw NoPlatform(tried);
}

GlContext::GlContext(int threads, const GlLibraries& libraries) {
  const char* variable = std::getenv("PBF_GL");
  const std::string wanted = variable ? variable : "";
  if (!wanted.empty() && wanted != "osmesa" && wanted != "egl" && wanted != "egl-device")
    throw Error(ExitCode::bad_input, "environment variable PBF_GL is \"" + wanted +
                                         "\"; use osmesa, egl or egl-device, or unset it");
  const auto limit = limit_threads(startable(threads));
  std::string tried, way;
  const auto attempt = [&](const char* name, const char* title, const auto& open) {
    if (platform_ || (!wanted.empty() && wanted != name)) return;
    way = title;
    try {
      platform_ = open();
    } catch (const NoPlatform& e) {
      if (tried.find(e.what()) == std::string::npos) tried += e.what();  // one library, two ways
    }
  };
  attempt("osmesa", "OSMesa", [&] { return open_osmesa(libraries.osmesa); });
  attempt("egl", "EGL surfaceless", [&] { return open_egl(libraries.egl, false); });
  attempt("egl-device", "EGL device", [&] { return open_egl(libraries.egl, true); });
  if (!platform_)
    throw Error(ExitCode::unavailable,
                "pictures need OpenGL 3.3 and none could be opened; tried:" + tried +
                    "\nInstall the package libosmesa6, or libegl1 and libgl1-mesa-dri" +
                    (wanted.empty() ? "" : " (PBF_GL=" + wanted + " allows no other way)") +
                    ", or leave pictures out (--set render=off).");
  const GlCurrent current(*this);
#define PBF_GL_LOAD(result, name, parameters)                                             \
  table_.name = reinterpret_cast<decltype(table_.name)>(platform_->function("gl" #name)); \
  if (!table_.name) throw Error(ExitCode::unavailable, way + " lacks the function gl" #name);
  PBF_GL_FUNCTIONS(PBF_GL_LOAD)
#undef PBF_GL_LOAD
  const auto* renderer = table_.GetString(gl::RENDERER);
  backend_ = way + ", " + (renderer ? reinterpret_cast<const char*>(renderer) : "unknown renderer");
}

GlContext::~GlContext() = default;

}  // namespace pbf::render_module
