// SPDX-License-Identifier: Apache-2.0
// Small pieces that several panels are made of.
#pragma once

#include <imgui.h>

#include <array>
#include <string>
#include <vector>

#include "app/window/toolkit/event_log.h"
#include "mercury/vec3.h"

namespace mercury::window {

// A heading with a line, and room above it.
void heading(const char* text);

// A row: the name on the left, the following item as wide as the rest of the row. `hint` appears when the mouse rests
// on the name.
void row(const char* name, const char* hint = nullptr);

// Whether the pointer has rested for a while on the item that was just put. Asked of one that is hovered.
bool pointer_rests();

// The text in a tooltip of the item that was just put, when the pointer rests there.
void tooltip(const char* text);

// Text that is of less weight, wrapped at the panel's edge.
void note(const char* text);

// At the right edge of what is left of a row or table cell.
void right_aligned(const std::string& text);

// As wide as its text, lit while it is on. True when it was clicked.
bool toggle_button(const char* text, bool on);

struct SliderRange {
  float low, high;
  const char* format;  // as "%.2f s"
  bool logarithmic = false;
};
// A slider in a row; beside the name a button that puts it back to `standard`, shown where it differs. True when the
// value changed.
bool slider(const char* name, const char* hint, float& value, float standard, const SliderRange& range);
// Three of them.
bool slider(const char* name, const char* hint, Vec3& value, Vec3 standard, const SliderRange& range);

// One of several. True when it changed.
bool combo(const char* name, const char* hint, int& index, const std::vector<const char*>& names);

// A text field over a string, as wide as what is left or as set by SetNextItemWidth. True when Enter was pressed.
bool text_field(const char* id, std::string& text, const char* placeholder = "");

// Cuts a text to a width, with dots at its end, or in its middle for paths.
std::string shortened(const std::string& text, float width, bool middle = false);

}  // namespace mercury::window
