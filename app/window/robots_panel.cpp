#include "app/window/robots_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "app/window/theme.h"
#include "app/window/widgets.h"

namespace mercury::window {
namespace {

bool whole_number(const char* name, const char* explanation, int& value, int low, int high, Desk& desk, const char* item) {
  ImGui::PushID(name);
  row(name, explanation);
  const bool changed = ImGui::InputInt("##value", &value, 1, 10);
  desk.observations.item(item);
  ImGui::PopID();
  value = std::clamp(value, low, high);
  return changed;
}

// "~/robots" as the shell takes it.
std::filesystem::path path_from(std::string text) {
  while (!text.empty() && text.back() == ' ') text.pop_back();
  if (const char* home = std::getenv("HOME"); home && text.starts_with("~/")) text = home + text.substr(1);
  return text;
}

std::string joined(const std::filesystem::path& folder, const std::string& name) {
  return folder.empty() ? name : (folder / name).string();
}

void save_one(Desk& desk, RobotId robot, const std::string& text) {
  std::filesystem::path path = path_from(text);
  if (path.empty()) return;
  if (path.extension() != ".json" && path.extension() != ".cbor") path += ".json";
  desk.preferences.save_folder = path.parent_path().string();
  save_with_care(desk, "robot", [&desk, robot, path](bool overwrite) { return desk.scene.save(robot, path, overwrite); });
}

void save_many(Desk& desk, const std::vector<RobotId>& robots, const std::string& text) {
  const std::filesystem::path folder = path_from(text);
  if (folder.empty()) return;
  desk.preferences.save_folder = folder.string();
  save_with_care(desk, fmt::format("{} robots", robots.size()), [&desk, robots, folder](bool overwrite) {
    return desk.scene.save_all(robots, folder, RobotFormat::json, overwrite);
  });
}

void draw_work(Desk& desk) {
  for (const Work& work : desk.scene.work()) {
    ImGui::PushID(static_cast<int>(work.id));
    const float share = work.total > 0 ? static_cast<float>(work.done) / static_cast<float>(work.total) : 0;
    ImGui::ProgressBar(share, {ImGui::GetContentRegionAvail().x - 5 * ImGui::GetFontSize(), 0}, work.name.c_str());
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) desk.scene.cancel_work(work.id);
    ImGui::PopID();
  }
}

void figures_of(const RobotEntry& entry) {
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(entry.name.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::Text("%zu masses, %zu springs, %zu faces", entry.masses, entry.springs, entry.faces);
  ImGui::TextUnformatted(entry.file.empty() ? "not saved yet" : entry.file.c_str());
  if (entry.tuned) ImGui::TextUnformatted("its materials were changed");
  if (entry.exploded) ImGui::Text("exploded at %.3f s", entry.exploded_at);
  ImGui::PopStyleColor();
  ImGui::EndTooltip();
}

}  // namespace

void RobotsPanel::draw(Desk& desk, float aspect) {
  draw_list(desk, aspect);
  draw_work(desk);
  draw_changes(desk);
  draw_generation(desk);
}

void RobotsPanel::draw_list(Desk& desk, float aspect) {
  LiveScene& scene = desk.scene;
  const std::vector<RobotEntry> entries = scene.entries();
  const std::size_t selected = scene.selection().size();
  heading(fmt::format("{} robot{}{}", entries.size(), entries.size() == 1 ? "" : "s",
                      selected ? fmt::format(", {} selected", selected) : "").c_str());
  // Whole rows, and the heading.
  const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const float height = (std::clamp(static_cast<float>(entries.size()), 3.0f, 12.0f) + 1) * line + 2;
  if (!ImGui::BeginTable("list", 3, ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersOuter, {0, height})) return;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("springs", ImGuiTableColumnFlags_WidthFixed);
  ImGui::TableSetupColumn("shown", ImGuiTableColumnFlags_WidthFixed);
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableHeadersRow();
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(entries.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const RobotEntry& entry = entries[static_cast<std::size_t>(i)];
      ImGui::PushID(static_cast<int>(entry.id));
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      const bool changed = entry.unsaved && (entry.tuned || !entry.file.empty());
      if (entry.exploded) ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
      const std::string name = shortened(entry.name + (changed ? " *" : ""), ImGui::GetContentRegionAvail().x);
      if (ImGui::Selectable(name.c_str(), entry.selected, ImGuiSelectableFlags_AllowDoubleClick)) {
        if (ImGui::IsMouseDoubleClicked(0))
          frame_robots(desk, {entry.id}, aspect);
        else if (ImGui::GetIO().KeyShift && anchor_ != 0) {
          bool inside = false;
          for (const RobotEntry& other : entries) {
            const bool end = other.id == anchor_ || other.id == entry.id;
            if (inside || end) scene.select(other.id, false);
            if (end && anchor_ != entry.id) inside = !inside;
          }
        } else if (ImGui::GetIO().KeyCtrl)
          scene.toggle_selected(entry.id);
        else
          scene.select(entry.id);
        if (!ImGui::GetIO().KeyShift) anchor_ = entry.id;
      }
      if (entry.exploded) ImGui::PopStyleColor();
      if (i < 20) desk.observations.item(fmt::format("robot.{}", i));
      if (ImGui::IsItemHovered()) figures_of(entry);
      ImGui::TableNextColumn();
      ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
      ImGui::Text("%zu", entry.springs);
      ImGui::PopStyleColor();
      ImGui::TableNextColumn();
      bool shown = !entry.hidden;
      ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x, 0});
      if (ImGui::Checkbox("##shown", &shown)) scene.set_hidden(entry.id, !shown);
      ImGui::PopStyleVar();
      hint("whether it is drawn; it swims on either way");
      ImGui::PopID();
    }
  ImGui::EndTable();
}

void RobotsPanel::draw_changes(Desk& desk) {
  LiveScene& scene = desk.scene;
  const std::vector<RobotId> selection = scene.selection();
  const float width = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  ImGui::BeginDisabled(selection.empty());
  if (ImGui::Button("Duplicate", {width, 0})) scene.duplicate(selection);
  desk.observations.item("duplicate");
  hint("a copy of each selected robot (Ctrl D)");
  ImGui::SameLine();
  if (ImGui::Button("Mutate", {width, 0})) mutate(desk);
  desk.observations.item("mutate");
  hint("a changed copy of each selected robot (key M)");
  ImGui::SameLine();
  if (ImGui::Button("Remove", {width, 0})) scene.remove(selection);
  desk.observations.item("remove");
  hint("remove the selected robots (Delete)");
  ImGui::EndDisabled();
  if (ImGui::Button("Open...", {width, 0})) open(desk);
  desk.observations.item("open");
  hint("robots from files or a folder (Ctrl O); or drop them on the window");
  ImGui::SameLine();
  ImGui::BeginDisabled(scene.entries().empty());
  if (ImGui::Button(selection.empty() ? "Save all..." : "Save...", {width, 0})) save(desk);
  desk.observations.item("save");
  hint("the selected robots, or all where none is selected (Ctrl S)");
  ImGui::SameLine();
  if (ImGui::Button("Clear", {width, 0})) scene.clear();
  desk.observations.item("clear");
  hint("remove all robots; Ctrl Z brings them back");
  ImGui::EndDisabled();
}

void RobotsPanel::draw_generation(Desk& desk) {
  heading("Random robots");
  int kind = static_cast<int>(generation.kind);
  if (choice("kind", "voxel: patches of muscle, tissue and bone. Network: grown by a neural network", kind, {"voxel", "network"}))
    generation.kind = static_cast<Generation::Kind>(kind);
  auto count = static_cast<int>(generation.count), seed = static_cast<int>(generation.seed);
  whole_number("count", "how many robots", count, 1, 4096, desk, "generate.count");
  whole_number("seed", "the same seed gives the same robots", seed, 0, 1'000'000'000, desk, "generate.seed");
  generation.count = static_cast<std::size_t>(count);
  generation.seed = static_cast<std::uint64_t>(seed);
  if (generation.kind == Generation::Kind::voxel) {
    RandomVoxelOptions& voxel = generation.voxel;
    row("smallest", "voxels along x, y and z");
    ImGui::InputInt3("##smallest", voxel.smallest.data());
    row("largest", "voxels along x, y and z");
    ImGui::InputInt3("##largest", voxel.largest.data());
    for (std::size_t i = 0; i < 3; ++i) {
      voxel.smallest[i] = std::clamp(voxel.smallest[i], 1, 24);
      voxel.largest[i] = std::clamp(voxel.largest[i], voxel.smallest[i], 24);
    }
    auto air = static_cast<float>(100 * voxel.air);
    if (slider("air", "share of the voxels that are empty", air, 30, {0, 90, "%.0f %%"})) voxel.air = std::clamp(static_cast<double>(air) / 100, 0.0, 0.95);
    int mirror = static_cast<int>(voxel.mirror);
    if (choice("symmetry", "halves that face each other along this axis", mirror, {"none", "x", "y", "z"})) voxel.mirror = static_cast<Mirror>(mirror);
  } else {
    auto points = static_cast<int>(generation.network.points);
    whole_number("points", "that the body is grown from", points, 64, 8192, desk, "generate.points");
    generation.network.points = static_cast<std::size_t>(points);
    auto mirrored = static_cast<float>(100 * generation.network.mirrored);
    if (slider("symmetry", "share of robots with alike halves", mirrored, 50, {0, 100, "%.0f %%"}))
      generation.network.mirrored = std::clamp(static_cast<double>(mirrored) / 100, 0.0, 1.0);
  }
  ImGui::Checkbox("Instead of those there are", &replace_);
  desk.observations.item("generate.replace");
  if (ImGui::Button("Generate", {-1, 0})) generate(desk);
  desk.observations.item("generate");
  hint("and count the seed up (key N)");
}

void RobotsPanel::generate(Desk& desk) {
  desk.scene.generate(generation, replace_);
  ++generation.seed;
}

void RobotsPanel::mutate(Desk& desk) {
  if (desk.scene.selection().empty()) {
    desk.toasts.say(Tone::news, "select the robots to mutate first");
    return;
  }
  desk.scene.mutate(desk.scene.selection(), mutation_);
  ++mutation_.seed;
}

void RobotsPanel::save(Desk& desk) {
  const std::vector<RobotId> robots = chosen_robots(desk.scene);
  if (robots.empty()) {
    desk.toasts.say(Tone::news, "there are no robots to save");
    return;
  }
  if (robots.size() > 1) {
    const std::string folder = desk.preferences.save_folder.empty() ? "robots" : desk.preferences.save_folder;
    desk.dialogs.ask_text(fmt::format("Save {} robots", robots.size()), "Folder, one JSON file a robot:", folder, "Save",
                          [&desk, robots](const std::string& text) { save_many(desk, robots, text); });
    return;
  }
  const RobotId robot = robots.front();
  std::string name;
  for (const RobotEntry& entry : desk.scene.entries())
    if (entry.id == robot) name = entry.file.empty() ? joined(desk.preferences.save_folder, file_name_of(entry.name) + ".json") : entry.file;
  desk.dialogs.ask_text("Save a robot", "File, .json or .cbor:", name, "Save",
                        [&desk, robot](const std::string& text) { save_one(desk, robot, text); });
}

void RobotsPanel::open(Desk& desk) {
  desk.dialogs.ask_text("Open robots", "A robot file (.json, .cbor) or a folder of them:", desk.preferences.folder, "Open",
                        [&desk](const std::string& text) {
                          if (const std::filesystem::path path = path_from(text); !path.empty()) desk.scene.open({path});
                        });
}

}  // namespace mercury::window
