// An off-screen OpenGL 3.3 context and its functions. There are two ways to one without a window:
// OSMesa, and EGL on Mesa's surfaceless platform or on a device (NVIDIA's driver). Libraries are
// opened with dlopen(RTLD_LOCAL) and stay open for the life of the process: unloading LLVM
// underneath its own threads is not safe.
#pragma once

#include <dlfcn.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "lib/render/gl_table.h"

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

/// Names that dlopen tries, in this order.
struct GlLibraries {
  std::vector<std::string> osmesa{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
  std::vector<std::string> egl{"libEGL.so.1", "libEGL.so"};
};

/// Opens OSMesa, else EGL surfaceless, else an EGL device. The environment variable PBF_GL
/// (osmesa, egl or egl-device) asks for one of them and no other.
class GlContext {
 public:
  /// `threads`: cores that Mesa's rasteriser may take, 0 for all; with 1 it draws on the thread
  /// that asks for a picture and starts none of its own; the environment variable
  /// LP_NUM_THREADS wins. Mesa reads it once for each library and process: the first context
  /// decides. Throws Error(unavailable) with what was tried and what to install, Error(bad_input)
  /// for an unknown PBF_GL.
  explicit GlContext(int threads = 0, const GlLibraries& libraries = {});
  ~GlContext();

  void make_current() { platform_->make_current(); }
  void release() { platform_->release(); }
  const gl::Table& gl() const { return table_; }
  const std::string& backend() const { return backend_; }  ///< "OSMesa, llvmpipe (...)"

 private:
  std::unique_ptr<GlPlatform> platform_;
  gl::Table table_;
  std::string backend_;
};

/// Makes the context current for the calling thread until the end of the scope.
class GlCurrent {
 public:
  explicit GlCurrent(GlContext& context) : context_(context) { context_.make_current(); }
  ~GlCurrent() { context_.release(); }
  GlCurrent(const GlCurrent&) = delete;

 private:
  GlContext& context_;
};

}  // namespace pbf::render_module
