// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/key_bindings.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace mercury::window {
namespace {

constexpr KeyBinding table[] = {
    {Action::play_pause, "play_pause", "Space", "play or pause", "Time", false, "start stop run continue freeze"},
    {Action::step, "step", "Right or .", "one step", "Time", true},
    {Action::step_back, "step_back", "Left or Comma", "one step back", "Time", true},
    {Action::first_moment, "first_moment", "Home", "the first moment of the timeline", "Time"},
    {Action::present, "present", "End", "the present, or the end of a recording", "Time"},
    {Action::loop, "loop", "O", "begin a loop here, close it, end it", "Time"},
    {Action::bookmark, "bookmark", "X", "set or remove a bookmark", "Time"},
    {Action::next_bookmark, "next_bookmark", "PageDown", "the next bookmark", "Time"},
    {Action::previous_bookmark, "previous_bookmark", "PageUp", "the previous bookmark", "Time"},
    {Action::go_on, "go_on", "U", "go on from the moment shown", "Time"},
    {Action::fork, "fork", "Y", "fork the selected robots at the moment shown", "Time", false, "branch copy"},
    {Action::faster, "faster", "+", "faster", "Time", true},
    {Action::slower, "slower", "-", "slower", "Time", true, "motion"},
    {Action::real_time, "real_time", "0", "real time", "Time"},
    {Action::fastest, "fastest", "*", "as fast as possible", "Time"},
    {Action::reset, "reset", "R", "reset to the start", "Time", false, "restart again"},

    {Action::frame, "frame", "F", "frame the selected robots, or all", "Camera", false, "zoom fit center all"},
    {Action::follow, "follow", "G", "follow the selected robot, or stop", "Camera"},
    {Action::turntable, "turntable", "T", "circle the group, or stop", "Camera", false, "spin rotate orbit"},
    {Action::top_view, "top_view", "Z", "look straight down, or stop", "Camera", false, "above"},
    {Action::look_along_x, "look_along_x", "", "look along x", "Camera"},
    {Action::look_along_y, "look_along_y", "", "look along y", "Camera"},
    {Action::bookmark_1, "bookmark_1", "F5", "go to camera bookmark 1", "Camera"},
    {Action::bookmark_2, "bookmark_2", "F6", "go to camera bookmark 2", "Camera"},
    {Action::bookmark_3, "bookmark_3", "F7", "go to camera bookmark 3", "Camera"},
    {Action::bookmark_4, "bookmark_4", "F8", "go to camera bookmark 4", "Camera"},
    {Action::set_bookmark_1, "set_bookmark_1", "Shift F5", "set camera bookmark 1", "Camera"},
    {Action::set_bookmark_2, "set_bookmark_2", "Shift F6", "set camera bookmark 2", "Camera"},
    {Action::set_bookmark_3, "set_bookmark_3", "Shift F7", "set camera bookmark 3", "Camera"},
    {Action::set_bookmark_4, "set_bookmark_4", "Shift F8", "set camera bookmark 4", "Camera"},

    {Action::new_random, "new_random", "N", "new random robots", "Robots", false, "generate create"},
    {Action::mutate, "mutate", "M", "mutate: a changed copy of each selected robot", "Robots"},
    {Action::breed, "breed", "J", "breed: a child of the two selected robots", "Robots"},
    {Action::evolve, "evolve", "E", "evolve the selected robots, or all, in the background", "Robots", false,
     "optimize train"},
    {Action::edit_body, "edit_body", "Ctrl E", "edit the body of the selected robot, or stop", "Robots", false,
     "paint voxels draw"},
    {Action::rename, "rename", "Ctrl R", "rename the selected robot", "Robots"},
    {Action::duplicate, "duplicate", "Ctrl D", "duplicate the selected robots", "Robots", false, "copy clone"},
    {Action::remove, "remove", "Delete", "remove the selected robots", "Robots", false, "delete erase"},
    {Action::keep_selected, "keep_selected", "", "remove all robots but the selected ones", "Robots"},
    {Action::keep_best, "keep_best", "", "keep the best robots and remove the others", "Robots"},
    {Action::detach, "detach", "W", "remove pins and springs that stay attached", "Robots"},
    {Action::select_all, "select_all", "Ctrl A", "select all", "Robots"},
    {Action::invert_selection, "invert_selection", "Ctrl I", "select the robots that are not selected", "Robots"},
    {Action::deselect, "deselect", "Esc", "close a dialog, or clear the selection", "Robots"},
    {Action::undo, "undo", "Ctrl Z", "undo", "Robots", true, "back revert"},
    {Action::redo, "redo", "Ctrl Y or Ctrl Shift Z", "redo", "Robots", true, "again forward"},
    {Action::open, "open", "Ctrl O", "open robots or a scene", "Robots", false, "load file"},
    {Action::save_scene, "save_scene", "Ctrl S", "save the scene", "Robots", false, "write file"},
    {Action::save, "save", "Ctrl Shift S", "save robots", "Robots", false, "write file"},

    {Action::drag_arrows, "drag_arrows", "D", "drag arrows", "View"},
    {Action::contact_arrows, "contact_arrows", "Q", "contact arrows: forces of the ground on masses", "View"},
    {Action::force_arrows, "force_arrows", "Ctrl F", "force arrows: the net force on each mass", "View"},
    {Action::cells, "cells", "C", "robots stay in their cells, or travel", "View"},
    {Action::springs, "springs", "S", "springs instead of the skin", "View"},
    {Action::labels, "labels", "L", "names and distances", "View", false, "text captions"},
    {Action::legend, "legend", "K", "legend", "View"},
    {Action::theme, "theme", "B", "dark or light theme", "View", false, "appearance"},
    {Action::compare, "compare", "I", "two views of the same robots under different settings, or one", "View", false,
     "split side"},
    {Action::ghosts, "ghosts", "A", "ghosts of the selected robots as they were, or none", "View"},

    {Action::color_material, "color_material", "1", "color by material", "Colors"},
    {Action::color_activation, "color_activation", "2", "color by activation", "Colors"},
    {Action::color_strain, "color_strain", "3", "color by strain", "Colors"},
    {Action::color_force, "color_force", "4", "color by force", "Colors"},
    {Action::color_speed, "color_speed", "5", "color by speed", "Colors"},
    {Action::color_pressure, "color_pressure", "6", "color by pressure", "Colors"},
    {Action::color_energy, "color_energy", "7", "color by energy", "Colors"},
    {Action::color_stiffness, "color_stiffness", "8", "color by stiffness", "Colors"},
    {Action::color_power, "color_power", "9", "color by power", "Colors"},

    {Action::left_panels, "left_panels", "[", "collapse or open the left panels", "Window", false, "columns"},
    {Action::right_panels, "right_panels", "]", "collapse or open the right panels", "Window", false, "columns"},
    {Action::hide_panels, "hide_panels", "H", "hide or show all panels", "Window"},
    {Action::larger_text, "larger_text", "Ctrl +", "larger text", "Window", false, "font size"},
    {Action::smaller_text, "smaller_text", "Ctrl -", "smaller text", "Window", false, "font size"},
    {Action::full_screen, "full_screen", "F11", "full screen", "Window"},
    {Action::screenshot, "screenshot", "P or F2", "save a screenshot", "Window", false, "picture image photo"},
    {Action::record, "record", "V", "start or stop recording the window", "Window", false, "video film movie"},
    {Action::palette, "palette", "Ctrl K", "search commands, robots and settings", "Window"},
    {Action::messages, "messages", "", "all messages so far", "Window", false, "log"},
    {Action::help, "help", "F1 or ?", "help: keys and gestures of the mouse", "Window", false, "shortcuts manual"},
    {Action::quit, "quit", "Ctrl Q", "quit", "Window", false, "exit close"},
};

constexpr MouseGesture mouse_table[] = {
    {"Left drag", "turn the camera"},
    {"Right or middle drag", "move the camera"},
    {"Wheel", "zoom"},
    {"Click", "select a robot; with Shift: add or remove it"},
    {"Shift drag", "select the robots in a box"},
    {"Right click", "a menu for the robot"},
    {"Double click", "follow a robot"},
    {"Ctrl drag", "pull a mass; its force is shown. With Shift as well, the spring stays"},
    {"Ctrl right drag", "push all robots: every mass gets the velocity that is shown"},
    {"Rest on a robot", "its name, and details of the mass and spring there; a click keeps them in the side panel"},
    {"Drop files", "open their robots, or a run"},
};

struct NamedKey {
  std::string_view name;
  int key;
};
constexpr NamedKey named_keys[] = {{"Space", GLFW_KEY_SPACE},
                                   {"Esc", GLFW_KEY_ESCAPE},
                                   {"Enter", GLFW_KEY_ENTER},
                                   {"Tab", GLFW_KEY_TAB},
                                   {"Backspace", GLFW_KEY_BACKSPACE},
                                   {"Insert", GLFW_KEY_INSERT},
                                   {"Delete", GLFW_KEY_DELETE},
                                   {"Right", GLFW_KEY_RIGHT},
                                   {"Left", GLFW_KEY_LEFT},
                                   {"Down", GLFW_KEY_DOWN},
                                   {"Up", GLFW_KEY_UP},
                                   {"PageUp", GLFW_KEY_PAGE_UP},
                                   {"PageDown", GLFW_KEY_PAGE_DOWN},
                                   {"Home", GLFW_KEY_HOME},
                                   {"End", GLFW_KEY_END},
                                   {"Pause", GLFW_KEY_PAUSE},
                                   {"F1", GLFW_KEY_F1},
                                   {"F2", GLFW_KEY_F2},
                                   {"F3", GLFW_KEY_F3},
                                   {"F4", GLFW_KEY_F4},
                                   {"F5", GLFW_KEY_F5},
                                   {"F6", GLFW_KEY_F6},
                                   {"F7", GLFW_KEY_F7},
                                   {"F8", GLFW_KEY_F8},
                                   {"F9", GLFW_KEY_F9},
                                   {"F10", GLFW_KEY_F10},
                                   {"F11", GLFW_KEY_F11},
                                   {"F12", GLFW_KEY_F12}};

char32_t lower(char32_t c) { return c >= U'A' && c <= U'Z' ? c - U'A' + U'a' : c; }

// The character of a press. Keys of the number pad that type nothing with Ctrl count as what is printed on them.
char32_t character_of(const KeyPress& press) {
  if (press.character != 0) return lower(press.character);
  if (press.key == GLFW_KEY_KP_ADD) return U'+';
  if (press.key == GLFW_KEY_KP_SUBTRACT) return U'-';
  if (press.key == GLFW_KEY_KP_MULTIPLY) return U'*';
  return 0;
}

// The only character of a UTF-8 text; 0 if it has several or none, or cannot be printed.
char32_t only_character(std::string_view text) {
  if (text.empty()) return 0;
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 0;
  if (length != text.size()) return 0;
  char32_t character = length == 1 ? first : first & (0x7fU >> length);
  for (const char c : text.substr(1)) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xc0) != 0x80) return 0;
    character = character << 6 | (byte & 0x3fU);
  }
  const bool shortest = length < 3 || character >= 0x800;
  const bool surrogate = character >= 0xd800 && character < 0xe000;
  return character > U' ' && character != 0x7f && shortest && !surrogate ? character : 0;
}

std::string utf8(char32_t c) {
  const auto byte = [](char32_t value) { return static_cast<char>(static_cast<unsigned char>(value)); };
  if (c < 0x80) return {byte(c)};
  if (c < 0x800) return {byte(0xc0 | c >> 6), byte(0x80 | (c & 0x3f))};
  return {byte(0xe0 | c >> 12), byte(0x80 | (c >> 6 & 0x3f)), byte(0x80 | (c & 0x3f))};
}

}  // namespace

std::span<const KeyBinding> key_bindings() { return table; }
std::span<const MouseGesture> mouse_gestures() { return mouse_table; }

bool is_enter(const KeyPress& press) {
  return press.character == 0 && (press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER);
}

bool KeyChord::matches(const KeyPress& press) const {
  const char32_t pressed = character_of(press);
  const bool same = character != 0 ? pressed == character : pressed == 0 && key == press.key;
  // With Ctrl, the window system names the key and not what it types: "+" is "=" with Shift on many keyboards.
  const bool letter = character >= U'a' && character <= U'z';
  if (control && press.control && character != 0 && !letter && !shift)
    return same || (character == U'+' && pressed == U'=');
  return same && control == press.control && (shift == press.shift || (!control && !shift));
}

std::optional<KeyChord> key_chord(std::string_view text) {
  KeyChord chord;
  const auto modifier = [&](std::string_view name, bool& on) {
    const bool found = !on && text.starts_with(name) && text.size() > name.size() + 1 && text[name.size()] == ' ';
    if (found) text.remove_prefix(name.size() + 1);
    on = on || found;
  };
  modifier("Ctrl", chord.control);
  modifier("Shift", chord.shift);
  const auto* named = std::ranges::find(named_keys, text, &NamedKey::name);
  if (named != std::end(named_keys)) {
    chord.key = named->key;
    return chord;
  }
  chord.character = text == "Comma" ? U',' : lower(only_character(text));
  if (chord.character == 0 || (!chord.control && chord.shift)) return std::nullopt;
  return chord;
}

std::string text_of(const KeyChord& chord) {
  std::string text = chord.control ? "Ctrl " : "";
  if (chord.shift) text += "Shift ";
  if (chord.character == U',') return text + "Comma";
  if (chord.character >= U'a' && chord.character <= U'z')
    return text + static_cast<char>(chord.character - U'a' + U'A');
  if (chord.character != 0) return text + utf8(chord.character);
  const auto* named = std::ranges::find(named_keys, chord.key, &NamedKey::key);
  return named == std::end(named_keys) ? std::string{} : text + std::string(named->name);
}

}  // namespace mercury::window
