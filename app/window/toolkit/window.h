// SPDX-License-Identifier: Apache-2.0
// A window on the screen with an OpenGL context, and what the user does to it.
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

// No window can be opened here. what() is one line that names `mercury render`.
class NoDisplay : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What was typed, in order. A character is what the keyboard's layout makes of the key; other keys go by GLFW's
// numbers.
struct Press {
  char32_t character = 0;  // of a key without Ctrl or Alt that types one
  int key = 0;             // GLFW_KEY_*, where no character came
  bool control = false, shift = false;
  bool repeated = false;  // by holding the key
};

struct WindowSize {
  int width = 1280, height = 720;  // in screen coordinates
};

// The keys among events.
std::vector<Press> presses_of(const std::vector<InputEvent>& events);

// Everything that has to do with the system's windows. One at a time, used from one thread alone.
class Window {
 public:
  // Throws NoDisplay.
  Window(const std::string& title, WindowSize size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  render::Context& gl_context() { return *gl_context_; }
  GLFWwindow* handle() const { return window_; }

  bool asked_to_close() const;
  void close();
  void stay_open();  // whatever it was asked

  // Waits for something to happen, at most so long [s], then takes in what did. 0 = does not wait.
  void poll(double wait);
  void show_picture();  // swaps the buffers

  WindowSize size() const;      // in screen coordinates
  WindowSize pixels() const;    // of the framebuffer
  float content_scale() const;  // how much larger than usual text should be on this screen
  void set_title(const std::string& title);
  void toggle_full_screen();

  // Of mouse and keyboard, since it was opened.
  InputQueue& input() { return input_; }
  const InputQueue& input() const { return input_; }
  // Handed out once.
  std::vector<std::filesystem::path> take_dropped_files();
  // Whether anything came from the user since the last call.
  bool take_activity();

 private:
  void listen();
  void push(const InputEvent& event);

  GLFWwindow* window_ = nullptr;
  std::unique_ptr<render::Context> gl_context_;
  InputQueue input_;
  std::vector<std::filesystem::path> dropped_;
  bool active_ = true;
  struct {
    int x, y, width, height;
  } windowed_{0, 0, 0, 0};  // before full screen
};

}  // namespace mercury::window
