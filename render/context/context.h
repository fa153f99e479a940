// SPDX-License-Identifier: Apache-2.0
// OpenGL 4.5 contexts: without a display, through EGL or OSMesa, or an existing one that belongs to a window.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace mercury::render {

// No context of the requested kind is available. what() is one line that says what was tried.
class ContextError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class ContextKind {
  automatic,  // the first of the following that works
  egl,        // EGL on a GPU
  mesa,       // Mesa's software renderer through EGL
  osmesa,     // Mesa's software renderer through OSMesa, which needs no EGL
  window,     // of a window, adopted
};

// "auto", "egl", "mesa", "osmesa", "window".
std::string_view name_of(ContextKind kind);
// The reverse, for the kinds that make_context() accepts. Throws std::invalid_argument that lists them.
ContextKind context_kind_named(std::string_view name);

struct ContextOptions {
  ContextKind kind = ContextKind::automatic;
  int cuda_device = -1;  // >= 0: prefer the GPU with this CUDA ordinal, so that CUDA and OpenGL can share buffers
  bool debug = true;     // let the driver report misuse through KHR_debug
};

struct ContextMessages;

// One OpenGL 4.5 core context. It may be current on one thread at a time; its destructor destroys all GL objects.
// While a process uses OSMesa, it may use no other kind of context.
class Context {
 public:
  virtual ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  // Binds the context to the calling thread. Throws ContextError.
  virtual void make_current() = 0;
  // Leaves the calling thread without a context, so that another thread may bind this one.
  virtual void release() = 0;

  ContextKind kind() const { return kind_; }
  // For people: "EGL on NVIDIA H100 80GB HBM3, OpenGL 4.6" or "Mesa llvmpipe (software), OpenGL 4.5".
  const std::string& describe() const { return description_; }
  // The CPU draws.
  bool is_software() const { return software_; }
  // CUDA ordinal of the GPU that draws; -1 = none or unknown.
  int cuda_device() const { return cuda_device_; }
  // Errors and undefined, deprecated or unportable behavior that the driver has reported since the last call, as
  // "high: GL_INVALID_OPERATION in ...". Empty when all is well. Hints on speed are left out: each driver has its own.
  std::vector<std::string> take_messages();

 protected:
  Context();
  // Call with the context current: checks the version, registers for messages, fills in the description.
  // Throws ContextError below OpenGL 4.5.
  void inspect(ContextKind kind, bool debug);
  int cuda_device_ = -1;

 private:
  std::unique_ptr<ContextMessages> messages_;
  ContextKind kind_ = ContextKind::automatic;
  std::string description_;
  bool software_ = false;
};

// A context without a window, current on the calling thread. Throws ContextError.
std::unique_ptr<Context> make_context(const ContextOptions& options = {});

// Wraps a window's context that is current on the calling thread and belongs to the caller. `make_current` and
// `release` implement the member functions for this window.
std::unique_ptr<Context> adopt_context(std::function<void()> make_current, std::function<void()> release,
                                       bool debug = true);

}  // namespace mercury::render
