// The two ways to an OpenGL context without a window: OSMesa, and EGL on Mesa's surfaceless
// platform or on a device (NVIDIA's driver). Libraries are opened with dlopen(RTLD_LOCAL) and stay
// open for the life of the process: unloading LLVM underneath its own threads is not safe.
#pragma once

#include <dlfcn.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace pbf::render_module {

/// A context of OpenGL 3.3 core with no surface of its own; we draw into our own framebuffer.
class GlPlatform {
 public:
  virtual ~GlPlatform() = default;
  virtual void make_current() = 0;  ///< for the calling thread; throws Error(unavailable)
  virtual void release() = 0;       ///< from the calling thread
  virtual void* function(const char* name) const = 0;  ///< null when the library lacks it
};

/// Why a platform cannot be opened, in lines that begin with "\n  ".
struct NoPlatform : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Opens one platform. Throws NoPlatform.
std::unique_ptr<GlPlatform> open_osmesa(const std::vector<std::string>& libraries);
std::unique_ptr<GlPlatform> open_egl(const std::vector<std::string>& libraries, bool device);

/// dlopen of the first library that opens. Throws NoPlatform with the reasons of all.
void* open_library(const std::vector<std::string>& names);

/// Sets `function` to the one of that name; false when the library lacks it.
template <class Function>
bool load(void* library, Function& function, const char* name) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

}  // namespace pbf::render_module
