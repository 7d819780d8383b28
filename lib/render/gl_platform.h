// The two ways to an OpenGL context without a window: OSMesa, and EGL on Mesa's surfaceless
// platform or on a device (NVIDIA's driver). Libraries are opened with dlopen(RTLD_LOCAL) and stay
// open for the life of the process: unloading LLVM underneath its own threads is not safe.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace pbf::inline render_module {

/// A context of OpenGL 3.3 core with no surface of its own; we draw into our own framebuffer.
class GlPlatform {
 public:
  virtual ~GlPlatform() = default;
  virtual void make_current() = 0;  ///< for the calling thread; throws Error(unavailable)
  virtual void release() = 0;       ///< from the calling thread
  virtual void* function(const char* name) const = 0;  ///< null when the library lacks it
};

/// Opens one platform, or returns null and appends one line of reason to `tried`.
std::unique_ptr<GlPlatform> open_osmesa(const std::vector<std::string>& libraries,
                                        std::string& tried);
std::unique_ptr<GlPlatform> open_egl(const std::vector<std::string>& libraries, bool device,
                                     std::string& tried);

/// dlopen of the first library that opens; null with the reasons appended to `tried`.
void* open_library(const std::vector<std::string>& names, std::string& tried);

}  // namespace pbf::inline render_module
