// SPDX-License-Identifier: Apache-2.0
// A window on the screen with an OpenGL context and its input.
#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/window/toolkit/input_queue.h"
#include "render/context.h"

struct GLFWwindow;

namespace mercury::window {

// Thrown when no window can be opened. what() is one line that suggests `mercury render`.
class NoDisplay : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// One key press. Keys that type a character are identified by it, as the keyboard layout gives it; other keys by GLFW's
// number.
struct KeyPress {
  char32_t character = 0;  // 0 = the key types none
  int key = 0;             // GLFW_KEY_*; 0 for a typed character
  bool control = false, shift = false;
  bool repeated = false;  // by holding the key down
};

struct WindowSize {
  int width = 1280, height = 720;  // in screen coordinates
};

// The key presses among events, in order.
std::vector<KeyPress> key_presses_in(const std::vector<InputEvent>& events);

// All calls to the window system go through this class. Only one can exist at a time; use it from one thread.
class Window {
 public:
  // Throws NoDisplay.
  Window(const std::string& title, WindowSize size, bool paced = true);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  render::Context& gl_context() { return *gl_context_; }
  GLFWwindow* handle() const { return window_; }

  bool close_requested() const;
  void close();
  void cancel_close();

  // Waits up to `wait` seconds for input, then reads all that has arrived. 0 = does not wait.
  void poll(double wait);
  void swap_buffers();  // shows the picture

  WindowSize size() const;      // in screen coordinates
  WindowSize pixels() const;    // of the framebuffer
  float content_scale() const;  // how much larger text should be on this screen; 1 = normal
  void set_title(const std::string& title);
  void toggle_full_screen();

  // Mouse and keyboard input.
  InputQueue& input() { return input_; }
  const InputQueue& input() const { return input_; }
  // The files dropped on the window since the last call.
  std::vector<std::filesystem::path> take_dropped_files();
  // True if there was any input since the last call.
  bool take_activity();

 private:
  void install_callbacks();
  void push(const InputEvent& event);

  GLFWwindow* window_ = nullptr;
  std::unique_ptr<render::Context> gl_context_;
  InputQueue input_;
  std::vector<std::filesystem::path> dropped_;
  bool active_ = true;
  struct {
    int x, y, width, height;
  } windowed_{0, 0, 0, 0};  // position and size to return to from full screen
};

}  // namespace mercury::window
