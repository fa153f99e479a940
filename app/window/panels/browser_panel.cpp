// SPDX-License-Identifier: Apache-2.0
// The robots of a folder, each with a view and its size.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/live/scene_robots.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/embedded.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "app/window/viewport/thumbnails.h"
#include "mercury/inspect.h"
#include "mercury/origin.h"
#include "mercury/robot.h"
#include "mercury/robot_file.h"

namespace mercury::window {

// A robot file, or the reason why it cannot be used.
struct RobotFolderEntry {
  std::filesystem::path path;
  std::shared_ptr<const Robot> robot;  // null if the file cannot be used
  Inspection figures;
  std::string error;
};

class RobotFolderReader {
 public:
  // Starts to read at max_files `max_files` files. The destructor stops early.
  explicit RobotFolderReader(const std::filesystem::path& folder, std::size_t max_files = 500);

  const std::filesystem::path& folder() const { return folder_; }
  // The parent folder, then the folders inside, sorted by name.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }
  // How many files look like robots.
  std::size_t files() const { return files_.size(); }
  // The robots read since the last call.
  std::vector<RobotFolderEntry> take();
  // Why the folder cannot be read; empty = no error.
  const std::string& error() const { return error_; }

 private:
  void list();
  void read(std::stop_token stop);

  std::filesystem::path folder_;
  std::size_t max_files_;
  std::vector<std::filesystem::path> folders_, files_;
  std::string error_;
  std::mutex mutex_;
  std::vector<RobotFolderEntry> read_;
  std::jthread thread_;
};

class BrowserPanel : public Panel {
 public:
  void draw(PanelContext& context) override;
  // Takes over what was read.
  void work(PanelContext& context) override;

 private:
  void show_folder(const std::filesystem::path& folder);
  void draw_bar(PanelContext& context);
  void draw_card(PanelContext& context, std::size_t index, float width);

  std::unique_ptr<RobotFolderReader> reader_;
  std::vector<RobotFolderEntry> entries_;
  std::string folder_text_;
};

namespace {

std::string size_of(const RobotFolderEntry& entry) {
  return fmt::format("{} springs\n{:.2g} \xc3\x97 {:.2g} \xc3\x97 {:.2g} m", entry.figures.springs,
                     entry.figures.extent.x, entry.figures.extent.y, entry.figures.extent.z);
}

void show_details(const RobotFolderEntry& entry) {
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(26 * ImGui::GetFontSize());
  ImGui::TextUnformatted(entry.path.filename().string().c_str());
  if (entry.robot) {
    const Inspection& f = entry.figures;
    const std::string kind = kind_of(*entry.robot), environment = environment_of(*entry.robot);
    ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
    ImGui::TextUnformatted(
        fmt::format("{} masses, {} springs, {} faces\n{} % muscle, {} materials\n{}{}{}click to add it to the scene",
                    f.masses, f.springs, f.faces, f.springs ? 100 * f.muscles / f.springs : 0, f.materials.size(),
                    kind.empty() ? "" : kind + " robot", environment.empty() ? "" : " for " + environment,
                    kind.empty() && environment.empty() ? "" : "\n")
            .c_str());
    ImGui::PopStyleColor();
  } else {
    ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
    ImGui::TextUnformatted(brief(entry.error, 2000).c_str());
    ImGui::PopStyleColor();
  }
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

// A view, and the name and two lines of figures below it.
float card_height(float width) {
  return width * Thumbnails::height / Thumbnails::width + 3.5f * ImGui::GetTextLineHeight();
}

}  // namespace

RobotFolderReader::RobotFolderReader(const std::filesystem::path& folder, std::size_t max_files)
    : folder_(folder.lexically_normal()), max_files_(max_files) {
  list();
  thread_ = std::jthread([this](std::stop_token stop) { read(std::move(stop)); });
}

void RobotFolderReader::list() {
  std::error_code failure;
  std::filesystem::directory_iterator entries(folder_, failure);
  if (failure) error_ = failure.message();
  for (; !failure && entries != std::filesystem::directory_iterator(); entries.increment(failure)) {
    const std::filesystem::path& path = entries->path();
    std::error_code unknown;
    if (path.filename().string().starts_with(".")) continue;
    if (entries->is_directory(unknown))
      folders_.push_back(path);
    else if (find_robot_format(path))
      files_.push_back(path);
  }
  std::sort(folders_.begin(), folders_.end());
  std::sort(files_.begin(), files_.end());
  if (files_.size() > max_files_) files_.resize(max_files_);
  if (folder_.has_parent_path() && folder_ != folder_.root_path())
    folders_.insert(folders_.begin(), folder_.parent_path());
}

void RobotFolderReader::read(std::stop_token stop) {
  for (const std::filesystem::path& path : files_) {
    if (stop.stop_requested()) return;
    RobotFolderEntry entry{.path = path};
    try {
      auto robot = std::make_shared<Robot>(load_robot(path));
      entry.figures = inspect(*robot);
      entry.robot = std::move(robot);
    } catch (const std::exception& error) {
      entry.error = error.what();
    }
    const std::lock_guard lock(mutex_);
    read_.push_back(std::move(entry));
  }
}

std::vector<RobotFolderEntry> RobotFolderReader::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(read_, {});
}

void BrowserPanel::show_folder(const std::filesystem::path& folder) {
  entries_.clear();
  folder_text_ = folder.string();
  reader_.reset();
  if (!folder.empty()) {
    reader_ = std::make_unique<RobotFolderReader>(folder);
    return;
  }
  for (Robot& robot : sample_robots("")) {
    RobotFolderEntry entry{.path = robot.name, .figures = inspect(robot)};
    entry.robot = std::make_shared<Robot>(std::move(robot));
    entries_.push_back(std::move(entry));
  }
}

void BrowserPanel::draw_bar(PanelContext& context) {
  std::string& folder = context.preferences.folder;
  if (ImGui::Button("Samples")) folder.clear();
  context.log.item("browser.samples");
  tooltip("the sample robots of the program");
  ImGui::SameLine();
  if (ImGui::Button("Folder...")) {
    context.dialogs.ask_files(
        {.kind = FileRequest::Kind::folder,
         .title = "Folder of robots",
         .button = "Show",
         .extensions = {".json", ".cbor"},
         .folder = folder,
         .name = "",
         .formats = {}},
        [&context](const FileChoice& answer) { context.preferences.folder = answer.paths.front().string(); });
  }
  context.log.item("browser.choose");
  tooltip("choose a folder of robots");
  ImGui::SetNextItemWidth(-1);
  if (text_field("##folder", folder_text_, "sample robots") && !folder_text_.empty()) folder = folder_text_;
  context.log.item("browser.folder");
  tooltip("type a folder, then Enter");
  if (!reader_) return;
  if (!reader_->error().empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
    ImGui::TextWrapped("%s", reader_->error().c_str());
    ImGui::PopStyleColor();
  }
  if (reader_->folders().empty()) return;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##folders", fmt::format("{} folders", reader_->folders().size()).c_str())) {
    const std::string above = reader_->folder().parent_path().string();
    for (const std::filesystem::path& other : reader_->folders()) {
      const bool up = other.string() == above;
      if (ImGui::Selectable(up ? ".. (up)" : other.filename().string().c_str())) folder = other.string();
    }
    ImGui::EndCombo();
  }
}

void BrowserPanel::draw(PanelContext& context) {
  draw_bar(context);
  const bool shown = reader_ ? reader_->folder() == std::filesystem::path(context.preferences.folder).lexically_normal()
                             : !entries_.empty() && context.preferences.folder.empty();
  if (!shown) show_folder(context.preferences.folder);
  const std::size_t total = reader_ ? reader_->files() : entries_.size();
  note(total == 0 ? "no robots in this folder"
                  : fmt::format("{} of {} robots; click one to add it", entries_.size(), total).c_str());
  ImGui::BeginDisabled(entries_.empty());
  if (ImGui::Button("Add all", {-1, 0})) {
    std::vector<Robot> robots;
    for (const RobotFolderEntry& entry : entries_)
      if (entry.robot) robots.push_back(*entry.robot);
    context.scene.robots().add(std::move(robots));
  }
  context.log.item("browser.all");
  ImGui::EndDisabled();
  const float text = ImGui::GetFontSize(), spacing = ImGui::GetStyle().ItemSpacing.x;
  const float room = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
  const int columns = std::max(1, static_cast<int>((room + spacing) / (7.2f * text + spacing)));
  const float width = (room - static_cast<float>(columns - 1) * spacing) / static_cast<float>(columns);
  if (ImGui::BeginChild("cards", {0, 0})) {
    const auto in_row = static_cast<std::size_t>(columns);
    const float height = card_height(width) + ImGui::GetStyle().ItemSpacing.y;
    ImGuiListClipper rows;
    rows.Begin(static_cast<int>((entries_.size() + in_row - 1) / in_row), height);
    while (rows.Step())
      for (auto row = static_cast<std::size_t>(rows.DisplayStart); row < static_cast<std::size_t>(rows.DisplayEnd);
           ++row)
        for (std::size_t i = row * in_row; i < std::min((row + 1) * in_row, entries_.size()); ++i) {
          if (i > row * in_row) ImGui::SameLine();
          draw_card(context, i, width);
        }
  }
  ImGui::EndChild();
}

void BrowserPanel::draw_card(PanelContext& context, std::size_t index, float width) {
  const RobotFolderEntry& entry = entries_[index];
  const float line = ImGui::GetTextLineHeight(), image = width * Thumbnails::height / Thumbnails::width;
  const ImVec2 corner = ImGui::GetCursorScreenPos(), size{width, card_height(width)};
  ImGui::PushID(static_cast<int>(index));
  const bool clicked = ImGui::InvisibleButton("card", size);
  const bool hovered = ImGui::IsItemHovered();
  if (index < 30 && ImGui::IsItemVisible()) context.log.item(fmt::format("card.{}", index));
  ImGui::PopID();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = ImGui::GetStyle().ChildRounding;
  const ImVec2 end{corner.x + size.x, corner.y + size.y};
  list.AddRectFilled(corner, end, ImGui::GetColorU32(hovered ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg), rounding);
  const ImVec2 below{corner.x + width, corner.y + image};
  if (entry.robot)
    draw_thumbnail(context.thumbnails.find(fmt::format("{}@{}", entry.path.string(), fmt::ptr(entry.robot.get())),
                                           [robot = entry.robot] { return robot; }),
                   corner, below, ImDrawFlags_RoundCornersTop);
  else
    list.AddText({corner.x + 0.4f * line, corner.y + 0.4f * line}, palette().bad, "cannot be read");
  const float margin = 0.35f * line;
  const std::string name =
      entry.robot && !entry.robot->name.empty() ? entry.robot->name : entry.path.filename().string();
  list.AddText({corner.x + margin, below.y + 0.15f * line}, ImGui::GetColorU32(ImGuiCol_Text),
               shortened(name, width - 2 * margin).c_str());
  if (entry.robot) list.AddText({corner.x + margin, below.y + 1.2f * line}, palette().faint, size_of(entry).c_str());
  if (hovered && pointer_rests()) show_details(entry);
  if (clicked && entry.robot) context.scene.robots().add({*entry.robot});
  if (clicked && !entry.robot) context.toasts.show(Tone::error, entry.error);
}

void BrowserPanel::work(PanelContext&) {
  if (!reader_) return;
  std::vector<RobotFolderEntry> fresh = reader_->take();
  entries_.insert(entries_.end(), std::make_move_iterator(fresh.begin()), std::make_move_iterator(fresh.end()));
}

std::unique_ptr<Panel> make_browser_panel(PanelContext&) { return std::make_unique<BrowserPanel>(); }

}  // namespace mercury::window
