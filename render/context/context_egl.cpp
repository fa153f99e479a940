// SPDX-License-Identifier: Apache-2.0
// EGL without a surface: the renderer draws into framebuffer objects of its own.
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "render/context/context_headless.h"

namespace mercury::render {
namespace {

struct DeviceChoice {
  EGLDeviceEXT device = EGL_NO_DEVICE_EXT;
  int cuda_device = -1;
};

// libepoxy ends the process when it cannot open the libraries that find the drivers, so check first.
void require_egl() {
  static const char* const missing = []() -> const char* {
    const auto is_there = [](const char* library) { return dlopen(library, RTLD_LAZY | RTLD_GLOBAL) != nullptr; };
    if (!is_there("libEGL.so.1")) return "libEGL.so.1 is not installed";
    if (!is_there("libOpenGL.so.0") && !is_there("libGL.so.1")) return "libOpenGL.so.0 is not installed";
    return nullptr;
  }();
  if (missing) throw ContextError(missing);
}

// Whether a list of names separated by blanks contains this one.
bool lists(const char* extensions, std::string_view name) {
  std::string_view rest = extensions ? extensions : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

bool client_has(const char* extension) { return lists(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), extension); }

int cuda_ordinal(EGLDeviceEXT device) {
  EGLAttrib value = -1;
  if (!lists(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_NV_device_cuda")) return -1;
  return eglQueryDeviceAttribEXT(device, EGL_CUDA_DEVICE_NV, &value) ? int(value) : -1;
}

bool is_software(EGLDeviceEXT device) {
  return lists(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

// GPUs or software devices. Of the GPUs, the one with the wanted CUDA ordinal comes first, then those with any.
std::vector<DeviceChoice> devices(bool software, int wanted_cuda) {
  if (!client_has("EGL_EXT_device_enumeration") && !client_has("EGL_EXT_device_base")) return {};
  std::array<EGLDeviceEXT, 64> found{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(EGLint(found.size()), found.data(), &count)) return {};
  std::vector<DeviceChoice> result;
  for (EGLint i = 0; i < count; ++i)
    if (is_software(found[std::size_t(i)]) == software)
      result.push_back({found[std::size_t(i)], cuda_ordinal(found[std::size_t(i)])});
  const auto rank = [&](const DeviceChoice& d) { return d.cuda_device < 0 ? 2 : d.cuda_device == wanted_cuda ? 0 : 1; };
  std::stable_sort(result.begin(), result.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return result;
}

class EglContext : public Context {
 public:
  EglContext(EGLDisplay display, ContextKind kind, int cuda_device, const ContextOptions& options) : display_(display) {
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr))
      throw ContextError("the display cannot be opened");
    if (!lists(eglQueryString(display_, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
      throw ContextError("EGL_KHR_surfaceless_context is missing");
    create(options.debug);
    try {
      EglContext::make_current();
      cuda_device_ = cuda_device;
      inspect(kind, options.debug);
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~EglContext() override { destroy(); }

  void make_current() override {
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw ContextError("eglMakeCurrent failed");
  }
  void release() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

 private:
  void create(bool debug) {
    if (!eglBindAPI(EGL_OPENGL_API)) throw ContextError("EGL has no desktop OpenGL");
    const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                           4,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           5,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           debug ? EGL_CONTEXT_OPENGL_DEBUG : EGL_NONE,
                                           EGL_TRUE,
                                           EGL_NONE};
    context_ = eglCreateContext(display_, config(), EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT) throw ContextError("OpenGL 4.5 core is refused");
  }

  EGLConfig config() const {
    if (lists(eglQueryString(display_, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) return EGL_NO_CONFIG_KHR;
    const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                                       EGL_NONE};
    EGLConfig chosen = EGL_NO_CONFIG_KHR;
    EGLint count = 0;
    eglChooseConfig(display_, wanted.data(), &chosen, 1, &count);
    return chosen;
  }

  // The display stays initialized: contexts made from it later, or by others in this process, share it.
  void destroy() {
    if (context_ == EGL_NO_CONTEXT) return;
    if (eglGetCurrentContext() == context_) release();
    eglDestroyContext(display_, context_);
    context_ = EGL_NO_CONTEXT;
  }

  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

std::unique_ptr<Context> first_that_works(bool software, ContextKind kind, const ContextOptions& options) {
  std::string reason = "no device";
  for (const DeviceChoice& choice : devices(software, options.cuda_device)) {
    try {
      const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, choice.device, nullptr);
      return std::make_unique<EglContext>(display, kind, choice.cuda_device, options);
    } catch (const ContextError& error) {
      reason = error.what();
    }
  }
  throw ContextError(reason);
}

}  // namespace

std::unique_ptr<Context> make_egl_gpu_context(const ContextOptions& options) {
  require_egl();
  auto context = first_that_works(false, ContextKind::egl, options);
  if (context->is_software()) throw ContextError("the GPU's driver fell back to software");
  return context;
}

std::unique_ptr<Context> make_egl_mesa_context(const ContextOptions& options) {
  require_egl();
  std::string reason;
  try {
    return first_that_works(true, ContextKind::mesa, options);
  } catch (const ContextError& error) {
    reason = error.what();
  }
  if (!client_has("EGL_MESA_platform_surfaceless")) throw ContextError(reason);
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  auto context = std::make_unique<EglContext>(display, ContextKind::mesa, -1, options);
  // Without Mesa, another vendor's EGL may answer instead.
  if (!context->is_software()) throw ContextError("Mesa is not installed");
  return context;
}

}  // namespace mercury::render
