// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/key_bindings.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cctype>

namespace mercury::window {
namespace {

constexpr KeyBinding table[] = {
    {Action::play_pause, "Space", "play or pause", "Time", 0, GLFW_KEY_SPACE, false, false},
    {Action::step, "Right or .", "one step", "Time", U'.', GLFW_KEY_RIGHT, false, true},
    {Action::faster, "+", "faster", "Time", U'+', GLFW_KEY_KP_ADD, false, true},
    {Action::slower, "-", "slower", "Time", U'-', GLFW_KEY_KP_SUBTRACT, false, true},
    {Action::real_time, "0", "real time", "Time", U'0', 0, false, false},
    {Action::fastest, "*", "as fast as possible", "Time", U'*', GLFW_KEY_KP_MULTIPLY, false, false},
    {Action::reset, "R", "reset to the start", "Time", U'r', 0, false, false},

    {Action::frame, "F", "frame the selected robots, or all", "Camera", U'f', 0, false, false},
    {Action::follow, "G", "follow the selected robot, or stop", "Camera", U'g', 0, false, false},
    {Action::turntable, "T", "circle the group, or stop", "Camera", U't', 0, false, false},
    {Action::top_view, "Z", "look straight down, or stop", "Camera", U'z', 0, false, false},

    {Action::new_random, "N", "new random robots", "Robots", U'n', 0, false, false},
    {Action::mutate, "M", "mutate: a changed copy of each selected robot", "Robots", U'm', 0, false, false},
    {Action::evolve, "E", "evolve the selected robots, in the background", "Robots", U'e', 0, false, false},
    {Action::duplicate, "Ctrl D", "duplicate the selected robots", "Robots", U'd', 0, true, false},
    {Action::remove, "Delete", "remove the selected robots", "Robots", 0, GLFW_KEY_DELETE, false, false},
    {Action::select_all, "Ctrl A", "select all", "Robots", U'a', 0, true, false},
    {Action::deselect, "Esc", "close a dialog, or clear the selection", "Robots", 0, GLFW_KEY_ESCAPE, false, false},
    {Action::undo, "Ctrl Z", "undo", "Robots", U'z', 0, true, true},
    {Action::redo, "Ctrl Y", "redo", "Robots", U'y', 0, true, true},
    {Action::open, "Ctrl O", "open robots or a scene", "Robots", U'o', 0, true, false},
    {Action::save_scene, "Ctrl S", "save the scene", "Robots", U's', 0, true, false},
    {Action::save, "Ctrl Shift S", "save robots", "Robots", U's', 0, true, false},

    {Action::drag_arrows, "D", "drag arrows", "Picture", U'd', 0, false, false},
    {Action::color, "1 - 9", "colour by a quantity, numbered as in the View panel", "Picture", U'1', 0, false, false},
    {Action::springs, "S", "springs instead of the skin", "Picture", U's', 0, false, false},
    {Action::labels, "L", "names and distances", "Picture", U'l', 0, false, false},
    {Action::legend, "K", "legend", "Picture", U'k', 0, false, false},
    {Action::theme, "B", "dark or light theme", "Picture", U'b', 0, false, false},
    {Action::hide_panels, "H", "hide or show the panels", "Picture", U'h', 0, false, false},
    {Action::full_screen, "F11", "full screen", "Picture", 0, GLFW_KEY_F11, false, false},
    {Action::screenshot, "P or F2", "save a screenshot", "Picture", U'p', GLFW_KEY_F2, false, false},
    {Action::record, "V", "start or stop recording the window", "Picture", U'v', 0, false, false},
    {Action::help, "F1 or ?", "this list", "Picture", U'?', GLFW_KEY_F1, false, false},
    {Action::quit, "Ctrl Q", "quit", "Picture", U'q', 0, true, false},
};

constexpr MouseGesture mouse_table[] = {
    {"Left drag", "turn the camera"},
    {"Right or middle drag", "move the camera"},
    {"Wheel", "zoom"},
    {"Click", "select a robot; with Shift: add or remove it"},
    {"Double click", "follow a robot"},
    {"Ctrl drag", "pull a mass; its force is shown"},
    {"Rest on a robot", "details of the mass and spring there"},
    {"Drop files", "open their robots, or a run"},
};

}  // namespace

std::span<const KeyBinding> key_bindings() { return table; }
std::span<const MouseGesture> mouse_gestures() { return mouse_table; }

bool is_enter(const KeyPress& press) {
  return press.character == 0 && (press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER);
}

std::optional<Command> command_of(const KeyPress& press) {
  const char32_t letter =
      press.character < 128 ? static_cast<char32_t>(std::tolower(static_cast<int>(press.character))) : press.character;
  if (!press.control && !press.repeated && letter >= U'1' && letter <= U'9')
    return Command{Action::color, static_cast<int>(letter - U'0')};
  for (const KeyBinding& binding : table) {
    const bool typed = letter != 0 && binding.character == letter && binding.action != Action::color;
    const bool pressed = letter == 0 && binding.key != 0 && binding.key == press.key;
    if ((!typed && !pressed) || binding.control != press.control) continue;
    if (press.repeated && !binding.repeats) return std::nullopt;
    if (binding.action == Action::undo && press.shift) return Command{Action::redo};
    if (binding.action == Action::save_scene && press.shift) return Command{Action::save};
    return Command{binding.action};
  }
  return std::nullopt;
}

}  // namespace mercury::window
