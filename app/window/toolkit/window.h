// SPDX-License-Identifier: Apache-2.0
// A window on the screen with an OpenGL context and its input.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/context/context.h"

struct GLFWwindow;

namespace mercury::window {

// Mouse and keyboard input, in order, shared out among frames.
//
// A frame may be slow (software rendering, many robots), and the user clicks and types meanwhile. A click must act on
// what the user saw at that place at that time, so one frame must not swallow several clicks. Each frame takes pointer
// moves and then one of:
//   1. one press or release of a mouse button: the next one may mean a dialog that this one opens;
//   2. turns of the wheel: the pointer must not move on before they act;
//   3. typed characters, up to the first key that types nothing (Enter, Esc, Ctrl S), for the reason of 1.
//
//   queue:  move press | release | move wheel wheel | 'a' 'b' Enter | move ...
//   frame:       1     |    2    |        3         |       4       |   5
struct InputEvent {
  enum class Kind { move, enter, focus, button, scroll, key, character } kind = Kind::move;
  double x = 0, y = 0;                     // move: position; scroll: offset
  bool on = false;                         // enter, focus: true = gained
  int code = 0;                            // button, key: GLFW's number; character: Unicode
  int scancode = 0, action = 0, mods = 0;  // as GLFW passes them
  char32_t name = 0;                       // key: the character printed on it; 0 = none
  bool types = false;                      // key: a character event follows
};

class InputQueue {
 public:
  void push(const InputEvent& event);
  // The events of one frame.
  std::vector<InputEvent> take();
  // True if events are left for the next frame.
  bool has_backlog() const { return !waiting_.empty(); }
  // How many presses of buttons and keys, and notches of the wheel, frames have taken so far.
  std::uint64_t taken() const { return taken_; }

 private:
  std::deque<InputEvent> waiting_;
  std::uint64_t taken_ = 0;
};

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
  void swap_buffers();  // shows the view

  WindowSize size() const;      // in screen coordinates
  WindowSize pixels() const;    // of the framebuffer
  float content_scale() const;  // how much larger text should be on this screen; 1 = normal
  void toggle_full_screen();

  // Mouse and keyboard input.
  InputQueue& input() { return input_; }
  const InputQueue& input() const { return input_; }
  // The files dropped on the window since the last call.
  std::vector<std::filesystem::path> take_dropped_files();
  // True if there was any input since the last call.
  bool take_activity();
  // True if what the window showed may be lost since the last call: it has another size, or another window covered it.
  bool take_exposure();

 private:
  void install_callbacks();
  void push(const InputEvent& event);

  GLFWwindow* window_ = nullptr;
  std::unique_ptr<render::Context> gl_context_;
  InputQueue input_;
  std::vector<std::filesystem::path> dropped_;
  bool active_ = true, exposed_ = true;
  struct {
    int x, y, width, height;
  } windowed_{0, 0, 0, 0};  // position and size to return to from full screen
};

}  // namespace mercury::window
