// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/window.h"

#include <epoxy/gl.h>
// After epoxy, which declares OpenGL.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "render/context/context_headless.h"

namespace mercury::window {
namespace {

std::string& last_error() {
  static std::string text;
  return text;
}

void on_error(int, const char* text) { last_error() = text; }

Window& window_of(GLFWwindow* handle) { return *static_cast<Window*>(glfwGetWindowUserPointer(handle)); }

// GLFW's last error message, without its prefix.
std::string reason() {
  const std::string& text = last_error();
  const std::size_t colon = text.find(": ");
  return text.empty() ? "no reason was given" : colon == std::string::npos ? text : text.substr(colon + 2);
}

void start_glfw() {
  glfwSetErrorCallback(on_error);
  if (!glfwInit())
    throw NoDisplay("no display to open a window on (" + reason() +
                    "); mercury render makes videos and pictures without one");
}

GLFWwindow* open_window(const std::string& title, WindowSize size) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SAMPLES, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "mercury");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "mercury");
  GLFWwindow* window = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (!window) {
    const std::string why = reason();
    glfwTerminate();
    throw NoDisplay("the display has no OpenGL 4.5 (" + why + "); mercury render makes videos and pictures without it");
  }
  return window;
}

}  // namespace

Window::Window(const std::string& title, WindowSize size, bool paced) {
  render::require_room_to_draw();  // whether the display has a GPU is known too late
  start_glfw();
  window_ = open_window(title, size);
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(paced ? 1 : 0);
  glfwSetWindowSizeLimits(window_, 640, 400, GLFW_DONT_CARE, GLFW_DONT_CARE);
  install_callbacks();
  try {
    gl_context_ =
        render::adopt_context([this] { glfwMakeContextCurrent(window_); }, [] { glfwMakeContextCurrent(nullptr); });
  } catch (const render::ContextError& error) {
    glfwDestroyWindow(window_);
    glfwTerminate();
    throw NoDisplay(std::string(error.what()) + "; mercury render makes videos and pictures without a window");
  }
}

Window::~Window() {
  gl_context_.reset();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::push(const InputEvent& event) {
  active_ = true;
  input_.push(event);
}

void Window::install_callbacks() {
  using Kind = InputEvent::Kind;
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* handle, int key, int scancode, int action, int mods) {
    const bool control = (mods & (GLFW_MOD_CONTROL | GLFW_MOD_SUPER)) != 0;
    const char* name = glfwGetKeyName(key, scancode);
    const char32_t letter = name && !name[1] ? static_cast<unsigned char>(name[0]) : 0;
    window_of(handle).push({.kind = Kind::key,
                            .code = key,
                            .scancode = scancode,
                            .action = action,
                            .mods = mods,
                            .name = letter,
                            .types = name && !control});
  });
  glfwSetCharCallback(window_, [](GLFWwindow* handle, unsigned character) {
    window_of(handle).push({.kind = Kind::character, .code = static_cast<int>(character)});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* handle, int button, int action, int mods) {
    window_of(handle).push({.kind = Kind::button, .code = button, .action = action, .mods = mods});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* handle, double x, double y) {
    window_of(handle).push({.kind = Kind::scroll, .x = x, .y = y});
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* handle, double x, double y) {
    window_of(handle).push({.kind = Kind::move, .x = x, .y = y});
  });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* handle, int entered) {
    window_of(handle).push({.kind = Kind::enter, .on = entered != 0});
  });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* handle, int focused) {
    window_of(handle).push({.kind = Kind::focus, .on = focused != 0});
  });
  glfwSetDropCallback(window_, [](GLFWwindow* handle, int count, const char** paths) {
    Window& self = window_of(handle);
    self.active_ = true;
    self.dropped_.insert(self.dropped_.end(), paths, paths + count);
  });
  const auto expose = [](GLFWwindow* handle, auto...) {
    window_of(handle).active_ = true;
    window_of(handle).exposed_ = true;
  };
  glfwSetFramebufferSizeCallback(window_, expose);
  glfwSetWindowRefreshCallback(window_, expose);
}

std::vector<KeyPress> key_presses_in(const std::vector<InputEvent>& events) {
  std::vector<KeyPress> presses;
  bool repeated = false;
  for (const InputEvent& event : events) {
    const bool control = (event.mods & (GLFW_MOD_CONTROL | GLFW_MOD_SUPER)) != 0;
    if (event.kind == InputEvent::Kind::key) repeated = event.action == GLFW_REPEAT;
    if (event.kind == InputEvent::Kind::key && event.action != GLFW_RELEASE && !event.types)
      presses.push_back({.character = event.name,
                         .key = event.code,
                         .control = control,
                         .shift = (event.mods & GLFW_MOD_SHIFT) != 0,
                         .repeated = repeated});
    // Space is handled as a key.
    if (event.kind == InputEvent::Kind::character && event.code != ' ')
      presses.push_back({.character = static_cast<char32_t>(event.code), .repeated = repeated});
  }
  return presses;
}

bool Window::close_requested() const { return glfwWindowShouldClose(window_); }
void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Window::cancel_close() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }

void Window::poll(double wait) {
  if (wait > 0)
    glfwWaitEventsTimeout(wait);
  else
    glfwPollEvents();
}

void Window::swap_buffers() { glfwSwapBuffers(window_); }

WindowSize Window::size() const {
  WindowSize size;
  glfwGetWindowSize(window_, &size.width, &size.height);
  return size;
}

WindowSize Window::pixels() const {
  WindowSize size;
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  return size;
}

float Window::content_scale() const {
  float across = 1, down = 1;
  glfwGetWindowContentScale(window_, &across, &down);
  // If the framebuffer has more pixels than the window has screen coordinates, the system already scales.
  const WindowSize coordinates = size(), framebuffer = pixels();
  const float done =
      coordinates.width > 0 ? static_cast<float>(framebuffer.width) / static_cast<float>(coordinates.width) : 1;
  return std::max(0.5f, across / std::max(done, 0.1f));
}

void Window::toggle_full_screen() {
  if (glfwGetWindowMonitor(window_)) {
    glfwSetWindowMonitor(window_, nullptr, windowed_.x, windowed_.y, windowed_.width, windowed_.height, GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  if (!mode) return;
  glfwGetWindowPos(window_, &windowed_.x, &windowed_.y);
  glfwGetWindowSize(window_, &windowed_.width, &windowed_.height);
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

std::vector<std::filesystem::path> Window::take_dropped_files() { return std::exchange(dropped_, {}); }
bool Window::take_activity() { return std::exchange(active_, false); }
bool Window::take_exposure() { return std::exchange(exposed_, false); }

using Kind = InputEvent::Kind;

void InputQueue::push(const InputEvent& event) {
  // Of several moves in a row, only the last position matters.
  if (event.kind == Kind::move && !waiting_.empty() && waiting_.back().kind == Kind::move)
    waiting_.back() = event;
  else
    waiting_.push_back(event);
}

std::vector<InputEvent> InputQueue::take() {
  std::vector<InputEvent> events;
  bool typed = false, scrolled = false;
  while (!waiting_.empty()) {
    const InputEvent event = waiting_.front();
    if ((event.kind == Kind::button && typed) || (event.kind == Kind::move && scrolled)) break;
    waiting_.pop_front();
    events.push_back(event);
    const bool press = event.action == GLFW_PRESS, of_key = event.kind == Kind::key,
               of_button = event.kind == Kind::button;
    typed = typed || of_key || event.kind == Kind::character;
    scrolled = scrolled || event.kind == Kind::scroll;
    if (event.kind == Kind::scroll || ((of_key || of_button) && press)) ++taken_;
    if (of_button || (of_key && !event.types && event.action != GLFW_RELEASE)) break;
  }
  return events;
}

}  // namespace mercury::window
