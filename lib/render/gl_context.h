// An off-screen OpenGL 3.3 context and its functions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lib/render/gl_platform.h"
#include "lib/render/gl_table.h"

namespace pbf::render_module {

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
