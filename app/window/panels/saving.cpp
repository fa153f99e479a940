// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/saving.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace mercury::window {
namespace {

std::string list_of(const std::vector<std::filesystem::path>& files) {
  std::string text = files.empty() ? "" : files.front().string();
  if (files.size() > 1) text += fmt::format(" and {} more", files.size() - 1);
  return text;
}

void report(PanelContext& context, const std::string& what, const SaveResult& result) {
  if (result.outcome == SaveResult::Outcome::failed) {
    context.toasts.show(Tone::error, result.message);
    context.dialogs.reopen_file_dialog(result.message);
    return;
  }
  context.preferences.save_folder = result.files.front().parent_path().string();
  context.toasts.show(Tone::success, fmt::format("{} saved: {}", what, list_of(result.files)));
  std::vector<std::string> files;
  for (const auto& file : result.files) files.push_back(file.string());
  context.log.write("saved", {{"what", what}, {"files", files}});
}

}  // namespace

void save_with_confirmation(PanelContext& context, const std::string& what,
                            std::function<SaveResult(bool overwrite)> save) {
  const SaveResult result = save(false);
  if (result.outcome != SaveResult::Outcome::exists) {
    report(context, what, result);
    return;
  }
  context.log.write("asks", {{"what", "overwrite"}});
  const std::string question =
      result.files.size() == 1 ? fmt::format("{} exists already.", result.files.front().string())
                               : fmt::format("{} files exist already: {}", result.files.size(), list_of(result.files));
  context.dialogs.ask({.title = "Replace?",
                       .text = question,
                       .button = "Replace",
                       .on_accept = [&context, what, save] { report(context, what, save(true)); },
                       .on_cancel = [&context] { context.dialogs.reopen_file_dialog(); }});
}

void save_csv(PanelContext& context, const std::string& what, std::function<std::string()> make) {
  context.dialogs.ask_files({.kind = FileRequest::Kind::save,
                             .title = "Save " + what,
                             .button = "Save",
                             .extensions = {".csv"},
                             .folder = context.preferences.save_folder,
                             .name = what + ".csv",
                             .formats = {}},
                            [&context, what, make = std::move(make)](const FileChoice& answer) {
                              const std::filesystem::path path = answer.paths.front();
                              save_with_confirmation(context, what, [&context, path, text = make()](bool overwrite) {
                                return context.scene.save_text(path, text, overwrite);
                              });
                            });
}

}  // namespace mercury::window
