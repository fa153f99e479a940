// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/evolution_commands.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/window/panels/evolve_form.h"

namespace mercury::window {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> run_of(const fs::path& path) {
  if (is_run_folder(path)) return path;
  if (path.filename() == "run.toml" && is_run_folder(path.parent_path())) return path.parent_path();
  return std::nullopt;
}

void show_panel(PanelContext& context) {
  context.preferences.panels = true;
  context.preferences.left_panel = "Evolution";
}

}  // namespace

void open_paths(PanelContext& context, const std::vector<fs::path>& paths) {
  std::vector<fs::path> robots;
  std::optional<fs::path> run;
  for (const fs::path& path : paths) {
    const std::optional<fs::path> found = run_of(path);
    if (!found)
      robots.push_back(path);
    else if (run)
      context.toasts.show(Tone::warning, found->string() + ": the window shows one run at a time");
    else
      run = found;
  }
  if (run) open_run(context, *run);
  context.scene.open(robots);
}

void open_run(PanelContext& context, const fs::path& folder) {
  show_panel(context);
  context.run.open(folder, [&context](std::vector<Robot> robots, const RunView& view) {
    context.scene.show(std::move(robots), view.settings.configuration, "open " + context.run.name());
  });
}

void open_first_run(PanelContext& context, const fs::path& folder) {
  show_panel(context);
  context.run.open(
      folder, [&context](std::vector<Robot> robots, const RunView&) { context.scene.add(std::move(robots), false); });
}

void choose_run(PanelContext& context) {
  context.dialogs.ask_files({.kind = FileRequest::Kind::folder,
                             .title = "Open a run: the folder of an evolution",
                             .button = "Open",
                             .extensions = {".toml"},
                             .folder = context.preferences.open_folder,
                             .name = "",
                             .formats = {}},
                            [&context](const FileChoice& answer) {
                              const fs::path folder = answer.paths.front();
                              context.preferences.open_folder = folder.parent_path().string();
                              if (is_run_folder(folder))
                                open_run(context, folder);
                              else
                                context.toasts.show(Tone::error, folder.string() + ": is no run, it has no run.toml");
                            });
}

void add_individual(PanelContext& context, std::uint64_t id) {
  context.run.grow(id, [&context](const Robot& robot) {
    const auto& robots = context.scene.document().robots;
    const auto same = std::ranges::find_if(robots, [&](const DocumentRobot& other) {
      return other.body.name == robot.name && *other.body.robot == robot;
    });
    if (same == robots.end()) {
      const std::vector<RobotId> added = context.scene.add({robot}, false);
      if (!added.empty()) context.scene.select(added.front());
      return;
    }
    context.scene.select(same->body.id);
  });
}

void evolve_selected(PanelContext& context) {
  if (context.scene.selection().empty())
    context.toasts.show(Tone::info, "select the robots to evolve first");
  else if (context.run.activity() != LiveRun::Activity::none)
    context.toasts.show(Tone::info, "an evolution is running already; stop it in the Evolution panel first");
  else
    ask_evolve(context);
}

}  // namespace mercury::window
