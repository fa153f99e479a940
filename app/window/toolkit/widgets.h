// SPDX-License-Identifier: Apache-2.0
// Small widgets that several panels use.
#pragma once

#include <imgui.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/window/toolkit/event_log.h"
#include "mercury/vec3.h"

namespace mercury::window {

// A heading with a line below and some space above.
void heading(const char* text);

// Starts a row: draws the name on the left, or in a line of its own if it is long, and makes the next item as wide as
// the rest of the row. `help` is the tooltip of the name.
void row(const char* name, const char* help = nullptr);

// Like row(), with a reset button beside the name if `differs`. Returns true when that button was clicked.
bool row_with_reset(const char* name, const char* help, bool differs, const char* reset_help = "reset to the default");

// True when the pointer has rested for a while on the item that was just drawn. Call only if that item is hovered.
bool pointer_rests();

// A tooltip for the item that was just drawn.
void tooltip(const char* text);
// The same at once, whatever the pointer is over. Long lines are wrapped, and long texts cut (brief()).
void tooltip_now(const std::string& text);

// Closes the list or menu that was opened last. Returns whether one was open.
bool close_list();

// Hides the tooltip of this frame: what the mouse rests on is below something else. Call after all that have tooltips.
void hide_tooltip();

// Secondary text in a fainter color, wrapped at the panel's edge.
void note(const char* text);

// Text at the right edge of a row or table cell.
void right_aligned(const std::string& text);

// A button that is highlighted while `on`. Returns true when it was clicked.
bool toggle_button(const char* text, bool on);

// The button of what a panel is for, in the accent color while it is enabled.
bool primary_button(const char* text, ImVec2 size = {0, 0});

// Sliders as ImGui's, whose number steps aside when the knob reaches it. Ctrl-click types a value. They return true
// when the value changed.
bool number_slider(const char* id, float& value, float low, float high, const char* format, bool logarithmic = false);
bool number_slider(const char* id, int& value, int low, int high, const char* format = "%d");

struct SliderRange {
  float low, high;
  const char* format;  // as "%.2f s"
  bool logarithmic = false;
};
// A row with a slider. A button that restores `default_value` appears where the value differs from it. Returns true
// when the value changed.
bool slider(const char* name, const char* help, float& value, float default_value, const SliderRange& range);
// The same for a vector.
bool slider(const char* name, const char* help, Vec3& value, Vec3 default_value, const SliderRange& range);

// A row with a list to choose from. Returns true when `index` changed.
bool combo(const char* name, const char* help, int& index, const std::vector<const char*>& names);

// A text field over a string; ImGui::SetNextItemWidth sets its width. Returns true when Enter was pressed.
bool text_field(const char* id, std::string& text, const char* placeholder = "");

// A text of at most about `letters` bytes: of a longer one, its beginning and its end. ImGui ends the program when one
// wrapped text has more than 16,383 letters.
std::string brief(const std::string& text, std::size_t letters);

// A name of the program as a label: "drag coefficient" for "drag_coefficient".
std::string label_of(std::string_view name);
// "kg/m3" with a raised 3.
std::string unit_text(std::string_view unit);

// Whether the last item is dragged: held, or let go in this frame, whose motion still counts. A slow frame may hold all
// of a drag's end.
bool item_dragged();

// Shortens a text to a width, with an ellipsis at its end or, for paths, in its middle.
std::string shortened(const std::string& text, float width, bool middle = false);

// How well a text fits a query: higher is better; none if a letter of the query is missing. Letters of the query must
// appear in order, in any case; blanks of the query are ignored. Letters that follow each other or begin a word count
// more, and a text that has little beside the query comes first. An empty query fits everything equally.
std::optional<int> fuzzy_match(std::string_view query, std::string_view text);
// Whether each word of the query begins a word of the text, in any case and order. An empty query fits everything.
bool words_match(std::string_view query, std::string_view text);

}  // namespace mercury::window
