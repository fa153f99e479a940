// SPDX-License-Identifier: Apache-2.0
// OSMesa, loaded on first use: without it, the program starts and draws through EGL.
//
// libepoxy supports only GLX and EGL, and ends the process under any other context. So while an OSMesa context is
// current, libepoxy's function pointers point to OSMesa's functions (gl_names.cpp lists them; the build generates it
// from epoxy's header).
#include <dlfcn.h>
#include <epoxy/gl.h>

#include <array>
#include <string>
#include <vector>

#include "render/context/context_headless.h"

namespace mercury::render {
namespace {

std::vector<void*>& saved() {
  static std::vector<void*> pointers;
  return pointers;
}

// Sets each pointer to what `find` returns for its name, if anything, and keeps the previous pointers.
void override_gl_pointers(void (*(*find)(const char*))()) {
  if (!saved().empty()) return;
  for (const GlPointer& entry : gl_pointers()) {
    saved().push_back(*entry.pointer);
    if (const auto function = find(entry.name)) *entry.pointer = reinterpret_cast<void*>(function);
  }
}

// Restores the previous pointers; does nothing if none were overridden.
void restore_gl_pointers() {
  for (std::size_t i = 0; i < saved().size(); ++i) *gl_pointers()[i].pointer = saved()[i];
  saved().clear();
}

// From GL/osmesa.h, so that its package is not needed to build.
using OsmesaHandle = void*;
using OsmesaFunction = void (*)();
constexpr int osmesa_format = 0x22;
constexpr int osmesa_rgba = 0x1908;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_major_version = 0x36;
constexpr int osmesa_minor_version = 0x37;

struct Library {
  OsmesaHandle (*create)(const int*, OsmesaHandle) = nullptr;
  unsigned char (*make_current)(OsmesaHandle, void*, GLenum, GLsizei, GLsizei) = nullptr;
  void (*destroy)(OsmesaHandle) = nullptr;
  OsmesaFunction (*find)(const char*) = nullptr;
};

template <typename Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (!function) throw ContextError(std::string("libOSMesa lacks ") + name);
}

const Library& osmesa() {
  static const Library loaded = [] {
    void* handle = nullptr;
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
      if (!handle) handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!handle) throw ContextError("libOSMesa is not installed");
    Library library;
    find(handle, "OSMesaCreateContextAttribs", library.create);
    find(handle, "OSMesaMakeCurrent", library.make_current);
    find(handle, "OSMesaDestroyContext", library.destroy);
    find(handle, "OSMesaGetProcAddress", library.find);
    return library;
  }();
  return loaded;
}

class OsmesaContext : public Context {
 public:
  explicit OsmesaContext(const ContextOptions& options) {
    const std::array<int, 9> attributes{osmesa_format,
                                        osmesa_rgba,
                                        osmesa_profile,
                                        osmesa_core_profile,
                                        osmesa_major_version,
                                        4,
                                        osmesa_minor_version,
                                        5,
                                        0};
    handle_ = osmesa().create(attributes.data(), nullptr);
    if (!handle_) throw ContextError("OpenGL 4.5 core is refused");
    try {
      OsmesaContext::make_current();
      inspect(ContextKind::osmesa, options.debug);
    } catch (...) {
      OsmesaContext::release();
      osmesa().destroy(handle_);
      throw;
    }
  }
  ~OsmesaContext() override {
    OsmesaContext::release();
    osmesa().destroy(handle_);
  }

  void make_current() override {
    if (!osmesa().make_current(handle_, pixels_.data(), GL_UNSIGNED_BYTE, side, side))
      throw ContextError("OSMesaMakeCurrent failed");
    override_gl_pointers(osmesa().find);
  }
  void release() override {
    restore_gl_pointers();
    osmesa().make_current(nullptr, nullptr, 0, 0, 0);
  }

 private:
  static constexpr int side = 16;  // of the context's own picture, which nothing is drawn into
  OsmesaHandle handle_ = nullptr;
  std::array<unsigned char, std::size_t(4 * side * side)> pixels_{};
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context(const ContextOptions& options) {
  return std::make_unique<OsmesaContext>(options);
}

}  // namespace mercury::render
