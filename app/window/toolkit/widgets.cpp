// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/widgets.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "app/window/toolkit/theme.h"

namespace mercury::window {
namespace {

constexpr float name_share = 0.42f;  // of a row's width
constexpr double rest_time = 0.4;    // of the pointer before a tooltip appears [s]
constexpr const char* dots = "\xe2\x80\xa6";
constexpr std::size_t longest_tooltip = 2000;  // [letters]

// The last place up to `at`, and the first from `at`, that does not cut a UTF-8 letter in two.
std::size_t letter_end(const std::string& text, std::size_t at) {
  while (at > 0 && at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) --at;
  return at;
}
std::size_t letter_begin(const std::string& text, std::size_t at) {
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) ++at;
  return at;
}

// Where the knob is: 0 = left, 1 = right.
float knob_place(float value, float low, float high, bool logarithmic) {
  if (!(high > low)) return 0;
  if (!logarithmic) return std::clamp((value - low) / (high - low), 0.0f, 1.0f);
  const float least = std::max(low, 1e-3f);  // ImGui's logarithmic sliders come near 0 in the same way
  return std::clamp(std::log(std::max(value, least) / least) / std::log(high / least), 0.0f, 1.0f);
}

// Where a number of this width is drawn on a slider: in the middle, or beside the knob if that is there. None = it fits
// on neither side.
std::optional<float> number_place(float low, float high, float knob, float gap, float width) {
  const float middle = (low + high - width) / 2;
  if (knob + gap <= middle || knob - gap >= middle + width) return middle;
  const bool left_fits = knob - gap - width > low, right_fits = knob + gap + width < high;
  if (right_fits && (knob < (low + high) / 2 || !left_fits)) return knob + gap;
  return left_fits ? std::optional(knob - gap - width) : std::nullopt;
}

// Draws the number of the slider that was just drawn, without its unit if only that has room beside the knob.
void draw_number(std::string_view text, float place) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float grab = ImGui::GetStyle().GrabMinSize;
  const float knob = low.x + 2 + grab / 2 + place * (high.x - low.x - 4 - grab);
  const float gap = grab / 2 + 0.3f * ImGui::GetFontSize();
  const auto width = [](std::string_view words) { return ImGui::CalcTextSize(words.begin(), words.end()).x; };
  std::optional<float> x = number_place(low.x, high.x, knob, gap, width(text));
  const bool number_last = text.starts_with("\xc3\x97") || std::isalpha(static_cast<unsigned char>(text.front()));
  if (!x && !number_last) {
    text = text.substr(0, text.find(' '));
    x = number_place(low.x, high.x, knob, gap, width(text));
  }
  ImGui::PushClipRect(low, high, true);
  ImGui::GetWindowDrawList()->AddText(
      {x.value_or((low.x + high.x - width(text)) / 2), (low.y + high.y - ImGui::GetFontSize()) / 2},
      ImGui::GetColorU32(ImGuiCol_Text), text.begin(), text.end());
  ImGui::PopClipRect();
}

// Draws a slider without its number, and the number where it can be read.
bool slider_with_number(const char* id, auto draw, auto number) {
  const ImGuiID item = ImGui::GetID(id);
  const bool typing = ImGui::TempInputIsActive(item);
  if (!typing) ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32_BLACK_TRANS);
  const bool changed = draw();
  if (!typing) ImGui::PopStyleColor();
  if (!ImGui::TempInputIsActive(item)) number();
  return changed;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool begins_word(std::string_view text, std::size_t i) {
  const auto is_part = [](char c) { return (lower(c) >= 'a' && c != ' ') || (c >= '0' && c <= '9') || c < 0; };
  return i == 0 || !is_part(text[i - 1]);
}

}  // namespace

bool number_slider(const char* id, float& value, float low, float high, const char* format, bool logarithmic) {
  const auto flags = ImGuiSliderFlags_NoRoundToFormat | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  return slider_with_number(
      id, [&] { return ImGui::SliderFloat(id, &value, low, high, format, flags); },
      [&] {
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), format, static_cast<double>(value));
        draw_number(text.data(), knob_place(value, low, high, logarithmic));
      });
}

bool number_slider(const char* id, int& value, int low, int high, const char* format) {
  return slider_with_number(
      id, [&] { return ImGui::SliderInt(id, &value, low, high, format); },
      [&] {
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), format, value);
        draw_number(text.data(),
                    knob_place(static_cast<float>(value), static_cast<float>(low), static_cast<float>(high), false));
      });
}

void heading(const char* text) {
  ImGui::Dummy({0, 0.2f * ImGui::GetFontSize()});
  ImGui::PushStyleColor(ImGuiCol_Text, palette().accent);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float y = corner.y - 0.5f * ImGui::GetStyle().ItemSpacing.y;
  ImGui::GetWindowDrawList()->AddLine({corner.x, y}, {corner.x + ImGui::GetContentRegionAvail().x, y}, palette().grid);
  ImGui::Dummy({0, 0.1f * ImGui::GetFontSize()});
}

// Without this delay, tooltips would flicker under a pointer that moves across a panel.
bool pointer_rests() {
  static ImVec2 place;
  static double since = 0;
  const ImVec2 corner = ImGui::GetItemRectMin();
  if (corner.x != place.x || corner.y != place.y || ImGui::IsMouseDown(0)) {
    place = corner;
    since = ImGui::GetTime();
  }
  return ImGui::GetTime() - since > rest_time;
}

void tooltip(const char* text) {
  if (text && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) && pointer_rests()) tooltip_now(text);
}

void tooltip_now(const std::string& text) {
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(22 * ImGui::GetFontSize());
  ImGui::TextUnformatted(brief(text, longest_tooltip).c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool close_list() {
  const ImVector<ImGuiPopupData>& open = ImGui::GetCurrentContext()->OpenPopupStack;
  const ImGuiWindow* const last = open.empty() ? nullptr : open.back().Window;
  if (!last || (last->Flags & ImGuiWindowFlags_Modal) != 0) return false;
  ImGui::ClosePopupToLevel(open.Size - 1, true);
  return true;
}

void hide_tooltip() {
  ImGuiWindow* const window = ImGui::FindWindowByName("##Tooltip_00");
  if (!window || !window->Active) return;
  window->Hidden = true;
  window->HiddenFramesCanSkipItems = 1;
}

bool row_with_reset(const char* name, const char* text, bool differs, const char* reset_text) {
  const float left = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x, names = name_share * width;
  const float side = 0.75f * ImGui::GetFrameHeight();
  const float room = differs ? names - side - 0.3f * ImGui::GetFontSize() : names;
  const bool is_long = ImGui::CalcTextSize(name).x > names;  // whether or not there is a button, so that rows stay
  if (is_long) {
    ImGui::TextUnformatted(shortened(name, width, true).c_str());
    tooltip(text);
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(is_long ? "" : shortened(name, room).c_str());
  tooltip(text);
  bool clicked = false;
  if (differs) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + names - side - 0.3f * ImGui::GetFontSize());
    const float top = ImGui::GetCursorPosY();
    ImGui::SetCursorPosY(top + (ImGui::GetFrameHeight() - side) / 2);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
    clicked = ImGui::Button("\xe2\x86\x90##reset", {side, side});
    ImGui::PopStyleVar();
    tooltip(reset_text);
    ImGui::SameLine();
    ImGui::SetCursorPosY(top);
  } else {
    ImGui::SameLine();
  }
  ImGui::SetCursorPosX(left + names);
  ImGui::SetNextItemWidth(width - names);
  return clicked;
}

void row(const char* name, const char* text) { row_with_reset(name, text, false); }

void right_aligned(const std::string& text) {
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, room));
  ImGui::TextUnformatted(text.c_str());
}

void note(const char* text) {
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

bool toggle_button(const char* text, bool on) { return on ? primary_button(text) : ImGui::Button(text); }

bool primary_button(const char* text, ImVec2 size) {
  ImGui::PushStyleColor(ImGuiCol_Button, palette().accent);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, palette().accent_hovered);
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, palette().accent);
  ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32_WHITE);
  const bool clicked = ImGui::Button(text, size);
  ImGui::PopStyleColor(4);
  return clicked;
}

bool slider(const char* name, const char* text, float& value, float default_value, const SliderRange& range) {
  ImGui::PushID(name);
  const bool reset = row_with_reset(name, text, value != default_value);
  float edited = value;
  bool changed = number_slider("##value", edited, range.low, range.high, range.format, range.logarithmic);
  tooltip("drag, or Ctrl-click to type");
  if (reset) {
    edited = default_value;
    changed = true;
  }
  ImGui::PopID();
  if (changed && std::isfinite(edited)) value = edited;
  return changed;
}

bool slider(const char* name, const char* text, Vec3& value, Vec3 default_value, const SliderRange& range) {
  ImGui::PushID(name);
  const bool reset = row_with_reset(name, text, value != default_value);
  float edited[3] = {value.x, value.y, value.z};
  bool changed =
      ImGui::DragFloat3("##value", edited, (range.high - range.low) / 400, range.low, range.high, range.format);
  tooltip("x, y and z: drag, or Ctrl-click to type");
  if (reset) {
    edited[0] = default_value.x, edited[1] = default_value.y, edited[2] = default_value.z;
    changed = true;
  }
  ImGui::PopID();
  if (changed && std::isfinite(edited[0]) && std::isfinite(edited[1]) && std::isfinite(edited[2]))
    value = {edited[0], edited[1], edited[2]};
  return changed;
}

bool combo(const char* name, const char* text, int& index, const std::vector<const char*>& names) {
  ImGui::PushID(name);
  row(name, text);
  const bool changed = ImGui::Combo("##choice", &index, names.data(), static_cast<int>(names.size()));
  ImGui::PopID();
  return changed;
}

bool text_field(const char* id, std::string& text, const char* placeholder) {
  std::array<char, 2048> letters{};
  std::snprintf(letters.data(), letters.size(), "%s", text.c_str());
  const bool entered =
      ImGui::InputTextWithHint(id, placeholder, letters.data(), letters.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  text = letters.data();
  return entered;
}

std::string brief(const std::string& text, std::size_t letters) {
  if (text.size() <= letters) return text;
  return text.substr(0, letter_end(text, letters / 2)) + dots +
         text.substr(letter_begin(text, text.size() - letters / 2));
}

std::string shortened(const std::string& text, float width, bool middle) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  const auto cut = [&](std::size_t kept) {
    const std::size_t head = letter_end(text, middle ? kept / 3 : kept);
    return text.substr(0, head) + dots +
           (middle ? text.substr(letter_begin(text, text.size() - (kept - kept / 3))) : "");
  };
  std::size_t fits = 0, too_much = text.size();
  while (too_much - fits > 1) {
    const std::size_t kept = (fits + too_much) / 2;
    (ImGui::CalcTextSize(cut(kept).c_str()).x <= width ? fits : too_much) = kept;
  }
  return fits > 0 ? cut(fits) : dots;
}

// best[i]: the best score of the query so far with its last letter at text[i].
std::optional<int> fuzzy_match(std::string_view query, std::string_view text) {
  constexpr int none = std::numeric_limits<int>::min();
  constexpr std::size_t most = 256;  // letters; what lies after is not searched
  text = text.substr(0, most);
  std::vector<int> best, next(text.size());
  for (const char letter : query.substr(0, most)) {
    if (letter == ' ') continue;
    if (text.empty()) return std::nullopt;
    int reachable = best.empty() ? 0 : none;  // the best score that ends before text[i - 1]
    const bool first = best.empty();
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (!first && i >= 2) reachable = std::max(reachable, best[i - 2]);
      const int beside = !first && i >= 1 && best[i - 1] != none ? best[i - 1] + 6 : none;
      const int from = std::max(beside, reachable);
      const bool same = lower(letter) == lower(text[i]) && from != none;
      next[i] = same ? from + 1 + (begins_word(text, i) ? 5 : 0) : none;
    }
    best = next;
  }
  if (best.empty()) return 0;
  const int score = *std::ranges::max_element(best);
  if (score == none) return std::nullopt;
  return 8 * score - static_cast<int>(text.size());
}

std::string label_of(std::string_view name) {
  std::string label(name);
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

std::string unit_text(std::string_view unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const bool is_power = i > 0 && std::isalpha(static_cast<unsigned char>(unit[i - 1]));
    text += is_power && unit[i] == '2' ? "\xc2\xb2" : is_power && unit[i] == '3' ? "\xc2\xb3" : std::string(1, unit[i]);
  }
  return text;
}

bool item_dragged() { return ImGui::IsItemActive() || ImGui::IsItemDeactivated(); }

bool words_match(std::string_view query, std::string_view text) {
  const auto begins_at = [&](std::string_view word, std::size_t place) {
    const std::string_view there = text.substr(place, word.size());
    return begins_word(text, place) &&
           std::ranges::equal(word, there, [](char a, char b) { return lower(a) == lower(b); });
  };
  for (std::size_t begin = 0, end = 0; begin < query.size(); begin = end + 1) {  // clang 14 lacks views::split
    end = std::min(query.find(' ', begin), query.size());
    const std::string_view word = query.substr(begin, end - begin);
    if (word.empty()) continue;
    bool found = false;
    for (std::size_t i = 0; i < text.size() && !found; ++i) found = begins_at(word, i);
    if (!found) return false;
  }
  return true;
}

}  // namespace mercury::window
