// SPDX-License-Identifier: Apache-2.0
#include "app/window/dialogs/file_dialog.h"
#define GLFW_INCLUDE_NONE

#include <GLFW/glfw3.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "app/window/toolkit/key_bindings.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/error.h"
#include "mercury/host_memory.h"
#include "mercury/robot_file.h"
#include "mercury/samples.h"

namespace mercury::window {
namespace {

namespace fs = std::filesystem;
using Kind = FileRequest::Kind;

constexpr int page = 10;  // rows of Page Up and Page Down

bool is_path(const std::string& text) { return text.find('/') != std::string::npos || text.starts_with("~"); }

namespace fs = std::filesystem;
using Kind = FileRequest::Kind;

std::string date_text(std::time_t time) {
  std::tm local{};
  return time == 0 || !localtime_r(&time, &local) ? "" : fmt::format("{:%Y-%m-%d %H:%M}", local);
}

// The icon before a name, drawn since the font has none.
void draw_icon(bool folder) {
  const float text = ImGui::GetFontSize();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (folder) {
    list.AddRectFilled({corner.x, corner.y + 0.2f * text}, {corner.x + 0.45f * text, corner.y + 0.5f * text},
                       palette().accent, 0.1f * text);
    list.AddRectFilled({corner.x, corner.y + 0.32f * text}, {corner.x + text, corner.y + 0.95f * text},
                       palette().accent, 0.1f * text);
  } else {
    list.AddRect({corner.x + 0.15f * text, corner.y + 0.1f * text}, {corner.x + 0.8f * text, corner.y + 0.97f * text},
                 palette().faint, 0.1f * text);
  }
  ImGui::Dummy({1.25f * text, text});
  ImGui::SameLine(0, 0);
}

// A label before an item that takes the rest of the row.
void label(const char* text, float width) {
  const float left = ImGui::GetCursorPosX();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text);
  ImGui::SameLine();
  ImGui::SetCursorPosX(left + width);
  ImGui::SetNextItemWidth(-1);
}

}  // namespace

void FileDialog::ask(FileRequest request, std::function<void(const FileChoice&)> on_accept) {
  request_ = std::move(request);
  on_accept_ = std::move(on_accept);
  view_ = FolderListing(request_.extensions);
  if (request_.folder.empty() || !view_.enter(request_.folder)) view_.enter(".");
  folder_text_ = view_.folder().string();
  error_.clear();
  set_text(request_.name);
  // Several formats may share an extension: the first of them.
  const auto found = std::ranges::find(request_.extensions, extension_of(text_));
  format_ = found == request_.extensions.end() ? 0 : static_cast<int>(found - request_.extensions.begin());
  open_ = just_opened_ = true;
}

void FileDialog::reopen(std::string error) {
  open_ = just_opened_ = on_accept_ != nullptr;
  error_ = std::move(error);
}

void FileDialog::set_text(std::string text) {
  text_ = std::move(text);
  ++text_edition_;
  focus_ = true;
}

// Typed text filters the list, unless it is a path.
void FileDialog::typed() {
  error_.clear();
  view_.clear_marks();
  if (request_.kind != Kind::open) return;
  view_.set_filter(is_path(text_) ? "" : text_);
  if (!text_.empty() && !is_path(text_) && !view_.items().empty()) view_.mark(0);
}

void FileDialog::enter(const fs::path& folder) {
  error_.clear();
  if (!view_.enter(folder)) error_ = view_.error();
  folder_text_ = view_.folder().string();
  if (request_.kind == Kind::open) set_text("");
  focus_ = true;
}

void FileDialog::go_up() {
  if (!view_.up()) return;
  folder_text_ = view_.folder().string();
  reveal_ = focus_ = true;
}

void FileDialog::press(const KeyPress& press) {
  if (press.character != 0 || !open_) return;
  const auto move = [&](int rows) {
    view_.move(rows);
    reveal_ = true;
  };
  switch (press.key) {
    case GLFW_KEY_UP:
      move(-1);
      break;
    case GLFW_KEY_DOWN:
      move(1);
      break;
    case GLFW_KEY_PAGE_UP:
      move(-page);
      break;
    case GLFW_KEY_PAGE_DOWN:
      move(page);
      break;
    case GLFW_KEY_BACKSPACE:
      if (text_.empty() && !folder_active_) go_up();
      break;
    default:
      entered_ = entered_ || is_enter(press);
  }
}

void FileDialog::click(std::size_t index) {
  const FolderItem item = view_.items()[index];
  const ImGuiIO& io = ImGui::GetIO();
  error_.clear();
  if (ImGui::IsMouseDoubleClicked(0)) {
    if (item.folder)
      enter(view_.folder() / item.name);
    else if (request_.kind != Kind::folder)
      accept();
    return;
  }
  if (request_.kind == Kind::open && io.KeyCtrl)
    view_.toggle(index);
  else if (request_.kind == Kind::open && io.KeyShift)
    view_.mark_to(index);
  else
    view_.mark(index);
  if (request_.kind == Kind::save && !item.folder) set_text(item.name);
}

void FileDialog::accept() {
  const std::vector<FolderItem> marked = view_.marked();
  if (marked.size() == 1 && marked.front().folder) {
    enter(view_.folder() / marked.front().name);
    return;
  }
  if (request_.kind == Kind::folder) {
    finish({text_.empty() ? view_.folder() : typed_path(view_.folder(), text_)});
    return;
  }
  if (request_.kind == Kind::save || marked.empty()) {
    accept_typed();
    return;
  }
  std::vector<fs::path> paths;
  for (const FolderItem& item : marked) paths.push_back(view_.folder() / item.name);
  finish(std::move(paths));
}

void FileDialog::accept_typed() {
  focus_ = true;
  fs::path path = typed_path(view_.folder(), text_);
  if (request_.kind == Kind::open) try {
      if (const fs::path sample = sample_or_path(text_); sample != text_) path = sample;
    } catch (const InputError& unknown_sample) {
      error_ = unknown_sample.what();
      return;
    }
  std::error_code unknown;
  if (path.empty() || fs::is_directory(path, unknown)) {
    if (path.empty())
      error_ = request_.kind == Kind::open ? "select a file in the list or type its name" : "type a name";
    else
      enter(path);
    return;
  }
  if (request_.kind == Kind::open && !fs::exists(path, unknown)) {
    error_ = path.string() + ": no such file";
    return;
  }
  const std::vector<std::string>& known = request_.extensions;
  if (request_.kind == Kind::save && !known.empty() && std::ranges::find(known, extension_of(path)) == known.end())
    path += known[static_cast<std::size_t>(request_.formats.empty() ? 0 : format_)];
  finish({std::move(path)});
}

void FileDialog::finish(std::vector<fs::path> paths) {
  choice_ = {std::move(paths), static_cast<std::size_t>(format_)};
  chosen_ = true;
  open_ = false;
}

void FileDialog::draw(EventLog& log) {
  if (!open_ && !shown_) return;
  const std::string id = request_.title + "###files";
  if (open_ && just_opened_) {
    ImGui::OpenPopup(id.c_str());
    focus_ = true;
    entered_ = false;
  }
  just_opened_ = false;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(0.94f * screen.x, 46 * text), std::min(0.94f * screen.y, 32 * text)});
  if (!ImGui::BeginPopupModal(id.c_str(), nullptr,
                              ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    open_ = shown_ = false;
    return;
  }
  shown_ = open_;
  if (open_) {
    draw_places(log);
    draw_items(log);
    draw_name(log);
    draw_buttons(log);
    if (std::exchange(entered_, false)) {
      if (folder_active_)
        enter(typed_path(view_.folder(), folder_text_));
      else
        accept();
    }
  }
  if (!open_) {  // answered, or Esc
    shown_ = false;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
  // It may open the next dialog.
  if (std::exchange(chosen_, false)) on_accept_(choice_);
}

bool FileDialog::opens_robots() const {
  return request_.kind == Kind::open && std::ranges::find(request_.extensions, ".json") != request_.extensions.end();
}

void FileDialog::draw_places(EventLog& log) {
  if (ImGui::Button("Up")) go_up();
  log.item("files.up");
  tooltip("parent folder (Backspace while the name is empty)");
  ImGui::SameLine();
  if (const char* home = std::getenv("HOME"); home && *home) {
    if (ImGui::Button("Home")) enter(home);
    log.item("files.home");
    ImGui::SameLine();
  }
  if (ImGui::Button("Start")) enter(fs::current_path());
  log.item("files.start");
  tooltip("the folder that the program was started in");
  ImGui::SameLine();
  const std::vector<std::string> samples = opens_robots() ? sample_names() : std::vector<std::string>();
  if (!samples.empty()) {
    if (ImGui::Button("Samples")) enter(sample_or_path(samples.front()).parent_path());
    log.item("files.samples");
    tooltip("the sample robots; the Browser panel shows pictures of them");
    ImGui::SameLine();
  }
  ImGui::SetNextItemWidth(-1);
  ImGui::PushID(view_.folder().string().c_str());
  text_field("##place", folder_text_);
  folder_active_ = ImGui::IsItemActive() || (folder_active_ && entered_);
  ImGui::PopID();
  log.item("files.place");
  tooltip("type a folder, then Enter");
}

void FileDialog::draw_items(EventLog& log) {
  const float lines = (error_.empty() ? 2.0f : 3.0f) + (request_.formats.empty() ? 0.0f : 1.0f) +
                      (request_.kind == Kind::folder ? 1.0f : 0.0f);
  const float height = ImGui::GetContentRegionAvail().y - lines * ImGui::GetFrameHeightWithSpacing();
  const auto flags =
      ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersOuter | ImGuiTableFlags_Sortable;
  if (!ImGui::BeginTable("items", 3, flags, {0, std::max(height, 4 * ImGui::GetFrameHeight())})) return;
  const float text = ImGui::GetFontSize();
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch | ImGuiTableColumnFlags_DefaultSort);
  ImGui::TableSetupColumn("size", ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_PreferSortDescending,
                          5 * text);
  ImGui::TableSetupColumn("changed", ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_PreferSortDescending,
                          9 * text);
  ImGui::TableHeadersRow();
  if (const ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs(); specs && specs->SpecsCount > 0)
    view_.sort(static_cast<FolderListing::Order>(specs->Specs[0].ColumnIndex),
               specs->Specs[0].SortDirection == ImGuiSortDirection_Descending);
  const float row_height = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  if (std::exchange(reveal_, false) && view_.cursor()) {
    const float row = row_height * static_cast<float>(*view_.cursor()),
                seen = ImGui::GetWindowHeight() - 2 * row_height;
    if (row < ImGui::GetScrollY()) ImGui::SetScrollY(row);
    if (row > ImGui::GetScrollY() + seen) ImGui::SetScrollY(row - seen);
  }
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(view_.items().size()), row_height);
  const fs::path folder = view_.folder();
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      // A click on an earlier row may have changed the folder.
      if (static_cast<std::size_t>(i) < view_.items().size() && view_.folder() == folder)
        draw_row(static_cast<std::size_t>(i), log);
  ImGui::EndTable();
}

void FileDialog::draw_row(std::size_t index, EventLog& log) {
  const FolderItem item = view_.items()[index];
  ImGui::PushID(static_cast<int>(index));
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const bool clicked = ImGui::Selectable("##row", item.marked,
                                         ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick);
  if (index < 20) log.item(fmt::format("file.{}", item.name));
  ImGui::SameLine(0, 0);
  draw_icon(item.folder);
  const bool dim = !item.folder && request_.kind == Kind::folder;
  if (dim) ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(shortened(item.name, ImGui::GetContentRegionAvail().x, true).c_str());
  if (dim) ImGui::PopStyleColor();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TableNextColumn();
  if (!item.folder) ImGui::TextUnformatted(byte_text(item.bytes).c_str());
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(date_text(item.changed).c_str());
  ImGui::PopStyleColor();
  ImGui::PopID();
  if (clicked) click(index);
}

void FileDialog::draw_name(EventLog& log) {
  if (!error_.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
    ImGui::TextUnformatted(shortened(error_, ImGui::GetContentRegionAvail().x, true).c_str());
    ImGui::PopStyleColor();
  }
  static constexpr const char* names[] = {"name", "name", "folder"};
  static constexpr const char* placeholders[] = {"part of a name, or a path", "a name, or a path",
                                                 "a folder inside this one; empty = this one"};
  const auto kind = static_cast<std::size_t>(request_.kind);
  const float names_width = 6 * ImGui::GetFontSize();
  label(names[kind], names_width);
  if (std::exchange(focus_, false)) ImGui::SetKeyboardFocusHere();
  const std::string before = text_;
  ImGui::PushID(text_edition_);
  text_field("##name", text_, placeholders[kind]);
  ImGui::PopID();
  log.item("dialog.text");
  if (request_.kind != Kind::open) tooltip("missing folders are created");
  if (text_ != before) typed();
  if (request_.kind == Kind::folder)
    note(shortened(
             request_.button + ": " + (text_.empty() ? view_.folder() : typed_path(view_.folder(), text_)).string(),
             ImGui::GetContentRegionAvail().x, true)
             .c_str());
  if (request_.formats.empty()) return;
  label("kind", names_width);
  if (ImGui::Combo("##kind", &format_, request_.formats.data(), static_cast<int>(request_.formats.size())) &&
      request_.kind == Kind::save)
    set_text(fs::path(text_).replace_extension(request_.extensions[static_cast<std::size_t>(format_)]).string());
  log.item("files.format");
  if (std::ranges::find(request_.extensions, ".cbor") != request_.extensions.end())
    tooltip("JSON is text; CBOR is the same data in a smaller file");
}

void FileDialog::draw_buttons(EventLog& log) {
  const float text = ImGui::GetFontSize(),
              width = std::max(7 * text, ImGui::CalcTextSize(request_.button.c_str()).x + 2 * text);
  if (request_.kind == Kind::open) {
    ImGui::BeginDisabled(view_.file_count() == 0);
    if (ImGui::Button(fmt::format("Open all {}", view_.file_count()).c_str())) {
      std::vector<fs::path> all;
      for (const FolderItem& item : view_.items())
        if (!item.folder) all.push_back(view_.folder() / item.name);
      finish(std::move(all));
    }
    log.item("files.all");
    ImGui::EndDisabled();
    tooltip("open all files that the list shows");
    ImGui::SameLine();
  }
  const float room = ImGui::GetContentRegionAvail().x - 2 * width - ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, room));
  if (ImGui::Button("Cancel", {width, 0})) open_ = false;
  log.item("files.cancel");
  ImGui::SameLine();
  const std::vector<FolderItem> marked = view_.marked();
  const bool into = marked.size() == 1 && marked.front().folder;
  if (primary_button(into ? "Open folder###accept" : (request_.button + "###accept").c_str(), {width, 0})) accept();
  log.item("files.accept");
}

}  // namespace mercury::window
