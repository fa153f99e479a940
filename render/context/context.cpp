// SPDX-License-Identifier: Apache-2.0
#include "render/context/context.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <utility>

#include "render/context/context_headless.h"

namespace mercury::render {
namespace {

constexpr std::array<std::pair<ContextKind, std::string_view>, 5> kind_names{{
    {ContextKind::automatic, "auto"},
    {ContextKind::egl, "egl"},
    {ContextKind::mesa, "mesa"},
    {ContextKind::osmesa, "osmesa"},
    {ContextKind::window, "window"},
}};

constexpr std::size_t most_messages = 100;  // a message per draw call must not fill the memory

const char* severity_name(unsigned severity) {
  switch (severity) {
    case GL_DEBUG_SEVERITY_HIGH:
      return "high";
    case GL_DEBUG_SEVERITY_MEDIUM:
      return "medium";
    default:
      return "low";
  }
}

std::string gl_string(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "";
}

// The name alone of "NVIDIA H100 80GB HBM3/PCIe/SSE2" and "llvmpipe (LLVM 15.0.6, 256 bits)".
std::string gpu_name(const std::string& renderer) {
  return renderer.substr(0, std::min(renderer.find('/'), renderer.find(" (")));
}

class WindowContext : public Context {
 public:
  WindowContext(std::function<void()> make_current, std::function<void()> release, bool debug)
      : make_current_(std::move(make_current)), release_(std::move(release)) {
    inspect(ContextKind::window, debug);
  }
  void make_current() override { make_current_(); }
  void release() override { release_(); }

 private:
  std::function<void()> make_current_, release_;
};

}  // namespace

// The driver writes them, perhaps from a thread of its own.
struct ContextMessages {
  std::mutex mutex;
  std::vector<std::string> lines;
};

namespace {

void GLAPIENTRY on_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                           const void* user) {
  // None of these is misuse: notifications say where buffers live, "other" carries shader statistics, "performance"
  // says that a shader is recompiled.
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION || type == GL_DEBUG_TYPE_OTHER || type == GL_DEBUG_TYPE_PERFORMANCE)
    return;
  std::string line = length < 0 ? std::string(text) : std::string(text, std::size_t(length));
  while (!line.empty() && (line.back() == '\n' || line.back() == '\0')) line.pop_back();
  auto& messages = *const_cast<ContextMessages*>(static_cast<const ContextMessages*>(user));
  const std::lock_guard lock(messages.mutex);
  if (messages.lines.size() < most_messages)
    messages.lines.push_back(std::string(severity_name(severity)) + ": " + line);
}

}  // namespace

std::string_view name_of(ContextKind kind) {
  for (const auto& [value, name] : kind_names)
    if (value == kind) return name;
  return "?";
}

ContextKind context_kind_named(std::string_view name) {
  for (const auto& [value, known] : kind_names)
    if (known == name && value != ContextKind::window) return value;
  throw std::invalid_argument("'" + std::string(name) + "' is not a context; give auto, egl, mesa or osmesa");
}

Context::Context() : messages_(std::make_unique<ContextMessages>()) {}
Context::~Context() = default;

std::vector<std::string> Context::take_messages() {
  const std::lock_guard lock(messages_->mutex);
  return std::exchange(messages_->lines, {});
}

void Context::inspect(ContextKind kind, bool debug) {
  kind_ = kind;
  const std::string renderer = gl_string(GL_RENDERER);
  const std::string version = gl_string(GL_VERSION);
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (10 * major + minor < 45)
    throw ContextError("OpenGL " + version.substr(0, version.find(' ')) + " on " + renderer +
                       ", Mercury draws with 4.5 or newer");
  software_ = renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos ||
              renderer.find("SWR") != std::string::npos;
  const std::string where = software_                     ? "Mesa " + gpu_name(renderer) + " (software)"
                            : kind == ContextKind::window ? gpu_name(renderer)
                                                          : "EGL on " + gpu_name(renderer);
  description_ = where + (kind == ContextKind::osmesa ? " through OSMesa" : "") + ", OpenGL " + version.substr(0, 3);
  if (!debug) return;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(on_message, messages_.get());
}

std::unique_ptr<Context> make_context(const ContextOptions& options) {
  if (options.kind == ContextKind::window) throw ContextError("a window's context is adopted, not made");
  const bool any = options.kind == ContextKind::automatic;
  std::string tried;
  const auto attempt = [&](ContextKind kind, const char* what, auto make) -> std::unique_ptr<Context> {
    if (!any && options.kind != kind) return nullptr;
    try {
      return make();
    } catch (const ContextError& error) {
      tried += std::string(tried.empty() ? "" : "; ") + what + ": " + error.what();
      return nullptr;
    }
  };
  if (auto context = attempt(ContextKind::egl, "EGL on a GPU", [&] { return make_egl_gpu_context(options); }))
    return context;
  if (options.kind != ContextKind::egl) require_room_to_draw();
  if (auto context = attempt(ContextKind::mesa, "Mesa through EGL", [&] { return make_egl_mesa_context(options); }))
    return context;
  if (auto context = attempt(ContextKind::osmesa, "OSMesa", [&] { return make_osmesa_context(options); }))
    return context;
  throw ContextError("no OpenGL 4.5 without a display here (" + tried + ")");
}

std::unique_ptr<Context> adopt_context(std::function<void()> make_current, std::function<void()> release, bool debug) {
  return std::make_unique<WindowContext>(std::move(make_current), std::move(release), debug);
}

}  // namespace mercury::render
