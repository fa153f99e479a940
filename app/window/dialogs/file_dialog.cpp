// SPDX-License-Identifier: Apache-2.0
#include "app/window/dialogs/file_dialog.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "app/window/toolkit/key_bindings.h"

namespace mercury::window {
namespace {

namespace fs = std::filesystem;
using Kind = FileRequest::Kind;

constexpr int page = 10;  // rows of Page Up and Page Down

bool is_path(const std::string& text) { return text.find('/') != std::string::npos || text.starts_with("~"); }

}  // namespace

void FileDialog::ask(FileRequest request, std::function<void(const FileChoice&)> on_accept) {
  request_ = std::move(request);
  on_accept_ = std::move(on_accept);
  view_ = FolderListing(request_.extensions);
  if (request_.folder.empty() || !view_.enter(request_.folder)) view_.enter(".");
  folder_text_ = view_.folder().string();
  error_.clear();
  set_text(request_.name);
  format_ = 0;
  for (std::size_t i = 0; i < request_.extensions.size(); ++i)
    if (fs::path(text_).extension() == request_.extensions[i]) format_ = static_cast<int>(i);
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
  if (request_.kind == Kind::save && !known.empty() &&
      std::find(known.begin(), known.end(), path.extension()) == known.end())
    path += known[static_cast<std::size_t>(request_.formats.empty() ? 0 : format_)];
  finish({std::move(path)});
}

void FileDialog::finish(std::vector<fs::path> paths) {
  choice_ = {std::move(paths), static_cast<std::size_t>(format_)};
  chosen_ = true;
  open_ = false;
}

}  // namespace mercury::window
