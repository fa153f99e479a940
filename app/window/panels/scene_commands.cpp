// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/scene_commands.h"

#include <imgui.h>

#include <nlohmann/json.hpp>
#include <variant>

namespace mercury::window {

void with_window_camera(PanelContext& context, const std::function<void()>& act) {
  const ViewSettings before = context.scene.view();
  ViewSettings view = before;
  view.camera = context.camera.plan();
  context.scene.set_view(view);
  act();
  context.scene.set_view(before);
}

void copy_as_command(PanelContext& context, const char* subcommand) {
  CommandText command;
  with_window_camera(context, [&] { command = context.scene.command(subcommand); });
  ImGui::SetClipboardText(command.text.c_str());
  context.log.write("copied", {{"text", command.text}});
  context.toasts.show(Tone::success, "copied: " + command.text);
  for (const std::string& line : command.notes) context.toasts.show(Tone::warning, line);
}

void toggle_drag_arrows(PanelContext& context) {
  ViewSettings view = context.scene.view();
  bool& drag = view.shown.arrows.drag;
  drag = !drag;
  if (drag && !has_face_forces(context.scene.configuration().environment))
    context.toasts.show(Tone::info, "only the ocean environment has drag arrows");
  context.log.write("view", {{"drag", drag}});
  context.scene.set_view(view);
}

}  // namespace mercury::window
