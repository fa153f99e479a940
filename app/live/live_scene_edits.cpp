// SPDX-License-Identifier: Apache-2.0
// Edits of the window's scene: robots, their voxels, parameters, materials, undo and redo.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/live/live_scene_parts.h"
#include "mercury/brain.h"
#include "mercury/error.h"

namespace mercury {

std::string LiveScene::Parts::free_name(const std::string& wanted) const {
  const auto taken = [&](const std::string& name) {
    return std::ranges::any_of(document.robots, [&](const DocumentRobot& robot) { return robot.body.name == name; });
  };
  if (!taken(wanted)) return wanted;
  for (int number = 2;; ++number)
    if (std::string name = fmt::format("{}-{}", wanted, number); !taken(name)) return name;
}

bool LiveScene::Parts::change_robots(const std::vector<RobotId>& robots, const char* name, const std::string& key,
                                     const std::function<bool(DocumentRobot&)>& change) {
  adopt_moment();
  SceneDocument after = document;
  bool any = false;
  for (const RobotId id : robots)
    for (DocumentRobot& robot : after.robots)
      if (robot.body.id == id) any = change(robot) || any;
  if (!any) return true;
  edit(name, key);
  document = std::move(after);
  apply_document();
  return true;
}

RobotId LiveScene::Parts::append(Robot robot, RobotProvenance source) {
  const RobotId id = ++last_id;
  LiveRobot body{.id = id, .name = robot.name.empty() ? "robot" : robot.name};
  body.robot = std::make_shared<const Robot>(std::move(robot));
  if (!source.file.empty()) saved.note(body, source.file);
  auto made = std::make_shared<const LiveRobot>(body);
  document.robots.push_back({std::move(body), std::move(source), std::move(made)});
  return id;
}

void LiveScene::Parts::remove_invalid(std::vector<Robot>& robots) {
  std::erase_if(robots, [&](const Robot& robot) {
    try {
      validate(robot);
      return false;
    } catch (const InputError& error) {
      report(Severity::error, (robot.name.empty() ? "robot" : robot.name) + ": " + error.what());
      return true;
    }
  });
}

std::vector<RobotId> LiveScene::Parts::append_valid(std::vector<Robot> robots, bool unsaved) {
  std::vector<RobotId> ids;
  for (Robot& robot : robots) {
    ids.push_back(append(std::move(robot), {}));
    if (!unsaved) saved.note(document.robots.back().body, "");
  }
  apply_document();
  return ids;
}

std::vector<RobotId> LiveScene::add(std::vector<Robot> robots, bool unsaved) {
  parts_->remove_invalid(robots);
  if (robots.empty()) return {};
  parts_->edit("add " + robot_count_text(robots.size()));
  return parts_->append_valid(std::move(robots), unsaved);
}

void LiveScene::show(std::vector<Robot> robots, const Configuration& configuration, const std::string& edit) {
  parts_->remove_invalid(robots);
  parts_->edit(edit);
  const Device device = parts_->document.configuration.device;
  parts_->document.configuration = configuration;
  parts_->document.configuration.device = device;
  parts_->document.robots.clear();
  parts_->append_valid(std::move(robots), false);
}

void LiveScene::remove(const std::vector<RobotId>& robots) {
  const std::set<RobotId> removed(robots.begin(), robots.end());
  const auto goes = [&](const DocumentRobot& robot) { return removed.contains(robot.body.id); };
  const auto count = std::ranges::count_if(parts_->document.robots, goes);
  if (count == 0) return;
  parts_->edit("remove " + robot_count_text(static_cast<std::size_t>(count)));
  std::erase_if(parts_->document.robots, goes);
  parts_->apply_document();
}

void LiveScene::clear() {
  std::vector<RobotId> all;
  for (const DocumentRobot& robot : parts_->document.robots) all.push_back(robot.body.id);
  remove(all);
}

void LiveScene::duplicate(const std::vector<RobotId>& robots) {
  std::vector<DocumentRobot> originals;
  for (const RobotId id : robots)
    if (const DocumentRobot* robot = parts_->document.find(id)) originals.push_back(*robot);
  if (originals.empty()) return;
  parts_->edit("duplicate " + robot_count_text(originals.size()));
  for (DocumentRobot& copy : originals) {
    copy.body.id = ++parts_->last_id;
    copy.body.name = parts_->free_name(copy.body.name);
    parts_->document.robots.push_back(std::move(copy));
  }
  parts_->apply_document();
}

void LiveScene::rename(RobotId robot, const std::string& name) {
  const DocumentRobot* before = parts_->find(robot);
  if (!before || name.empty() || before->body.name == name) return;
  parts_->edit("rename " + before->body.name);
  DocumentRobot* found = parts_->find(robot);
  if (!found) return;
  found->body.name = name;
  parts_->apply_document();
}

bool LiveScene::can_undo() const { return parts_->history.can_undo(); }
bool LiveScene::can_redo() const { return parts_->history.can_redo(); }
std::string LiveScene::undo_name() const { return parts_->history.undo_name(); }
std::string LiveScene::redo_name() const { return parts_->history.redo_name(); }
void LiveScene::forget_edits() { parts_->history.clear(); }
void LiveScene::end_edit() { parts_->history.end_edit(); }

void LiveScene::undo() {
  if (can_undo()) parts_->travel(&EditHistory::undo);
}
void LiveScene::redo() {
  if (can_redo()) parts_->travel(&EditHistory::redo);
}

void LiveScene::Parts::travel(void (EditHistory::*travel_in)(SceneDocument&)) {
  const std::vector<Attachment> before = document.attachments;
  const TrialStart start_before = document.start;
  (history.*travel_in)(document);
  apply_document();
  pulls.aim_pins(before, *snapshot);
  if (document.start != start_before) follow_start();
}

const Configuration& LiveScene::configuration() const { return parts_->document.configuration; }

bool LiveScene::set_configuration(const Configuration& configuration) {
  Configuration wanted = configuration;
  wanted.device = parts_->document.configuration.device;
  if (wanted == parts_->document.configuration) return true;
  try {
    validate(wanted);
  } catch (const InputError& error) {
    parts_->report(Severity::warning, error.what());
    return false;
  }
  if (!same_parts(wanted.environment, parts_->document.configuration.environment)) {
    parts_->edit(fmt::format("move to {}", name_of(wanted.environment)));
    parts_->document.surroundings = ++parts_->last_surroundings;
  } else {
    parts_->edit("change parameters", "parameters");
  }
  parts_->document.configuration = wanted;
  parts_->apply_document();
  if (!parts_->document.attachments.empty()) parts_->pulls.send();
  return true;
}

const TrialStart& LiveScene::start() const { return parts_->document.start; }

bool LiveScene::set_start(const TrialStart& start) {
  if (start == parts_->document.start) return true;
  try {
    validate(start.trials);
  } catch (const InputError& error) {
    parts_->report(Severity::warning, error.what());
    return false;
  }
  parts_->edit("change the start", "start");
  parts_->document.start = start;
  parts_->apply_document();
  parts_->follow_start();
  return true;
}

bool LiveScene::push(const Vec3& velocity) {
  constexpr double reaction = 0.1;  // physics has carried the change out by then [s]
  end_edit();
  Configuration configuration = parts_->document.configuration;
  configuration.environment.push = velocity;
  configuration.environment.push_at =
      static_cast<float>(snapshot().time + configuration.dt + reaction * snapshot().achieved_speed);
  const bool accepted = set_configuration(configuration);
  end_edit();
  return accepted;
}

std::span<const Material> LiveScene::materials(RobotId robot) const {
  const DocumentRobot* found = parts_->document.find(robot);
  return found ? materials_of(found->body) : std::span<const Material>{};
}

bool LiveScene::set_material(const std::vector<RobotId>& robots, MaterialId id, const Material& material) {
  try {
    validate(material, "material " + std::to_string(id));
  } catch (const InputError& error) {
    parts_->report(Severity::warning, error.what());
    return false;
  }
  return parts_->change_robots(robots, "change a material", fmt::format("material {}", id), [&](DocumentRobot& robot) {
    const auto now = materials_of(robot.body);
    if (id == air || id >= now.size() || now[id] == material) return false;
    auto table = std::make_shared<std::vector<Material>>(now.begin(), now.end());
    (*table)[id] = material;
    robot.body.materials = std::move(table);
    return true;
  });
}

bool LiveScene::scale_materials(const std::vector<RobotId>& robots, const MaterialScale& scale) {
  if (!std::isfinite(scale.stiffness) || scale.stiffness < 0 || !std::isfinite(scale.amplitude) ||
      !std::isfinite(scale.frequency) || !std::isfinite(scale.phase)) {
    parts_->report(Severity::warning, "materials: give finite factors, and at least 0 for the stiffness");
    return false;
  }
  return parts_->change_robots(robots, "tune materials", "materials", [&](DocumentRobot& robot) {
    const auto own = materials_of(*robot.body.robot);
    auto table = std::make_shared<std::vector<Material>>(own.begin(), own.end());
    for (std::size_t id = 1; id < table->size(); ++id) {
      Material& material = (*table)[id];
      material.stiffness = std::min(material.stiffness * scale.stiffness, 1e30f);
      material.amplitude = std::clamp(material.amplitude * scale.amplitude, -0.99f, 0.99f);
      material.frequency *= scale.frequency;
      if (material.amplitude != 0) material.phase += scale.phase;
    }
    if (!std::ranges::all_of(*table, [](const Material& material) { return is_valid(material); })) return false;
    if (std::ranges::equal(*table, materials_of(robot.body))) return false;
    robot.body.materials = std::ranges::equal(*table, own) ? nullptr : std::move(table);
    return true;
  });
}

void LiveScene::reset_materials(const std::vector<RobotId>& robots) {
  end_edit();
  parts_->change_robots(robots, "reset materials", {}, [](DocumentRobot& robot) {
    const bool tuned = robot.body.materials != nullptr;
    robot.body.materials.reset();
    return tuned;
  });
}

namespace {

// Holds one value of a list with `count` of them, or releases it. Returns whether that changes anything.
bool hold(LiveRobot& robot, std::vector<float> ByHand::*list, std::size_t count, std::size_t index,
          std::optional<float> wanted) {
  const float value = wanted.value_or(std::numeric_limits<float>::quiet_NaN());
  ByHand held = robot.by_hand ? *robot.by_hand : ByHand{};
  std::vector<float>& values = held.*list;
  values.resize(count, std::numeric_limits<float>::quiet_NaN());
  if (values[index] == value || (std::isnan(values[index]) && std::isnan(value))) return false;
  values[index] = value;
  const auto is_free = [](const std::vector<float>& all) {
    return std::ranges::all_of(all, [](float one) { return std::isnan(one); });
  };
  robot.by_hand =
      is_free(held.drives) && is_free(held.neurons) ? nullptr : std::make_shared<const ByHand>(std::move(held));
  return true;
}

bool release(LiveRobot& robot, std::vector<float> ByHand::*list) {
  bool changed = false;
  const std::size_t count = robot.by_hand ? (robot.by_hand.get()->*list).size() : 0;
  for (std::size_t i = 0; i < count; ++i) changed = hold(robot, list, count, i, std::nullopt) || changed;
  return changed;
}

}  // namespace

void LiveScene::drive_actuator(const std::vector<RobotId>& robots, const std::string& name,
                               std::optional<float> drive) {
  if (drive) drive = std::clamp(*drive, -1.0f, 1.0f);
  parts_->change_robots(robots, drive ? "drive an actuator" : "release an actuator", "drive " + name,
                        [&](DocumentRobot& robot) {
                          const std::vector<Actuator> actuators = actuators_of(*robot.body.robot);
                          const auto found = std::ranges::find(actuators, name, &Actuator::name);
                          if (found == actuators.end()) return false;
                          return hold(robot.body, &ByHand::drives, actuators.size(),
                                      static_cast<std::size_t>(found - actuators.begin()), drive);
                        });
}

void LiveScene::hold_opened(HeldParts held) {
  parts_->pulls.attach_later(std::move(held.attached));
  parts_->to_hold = std::move(held);
}

bool LiveScene::Parts::hold_opened(bool complete) {
  bool changed = false;
  // `what` is held: an element of ByHand::*list by the name that it has among the `names` of a robot.
  const auto hold_all = [&](std::vector<HeldValue>& waiting, const char* option, const char* what,
                            std::vector<float> ByHand::*list, const auto& names_of) {
    for (const HeldValue& one : std::exchange(waiting, {})) {
      if (one.robot >= document.robots.size()) {
        if (!complete)
          waiting.push_back(one);
        else
          report(Severity::warning, fmt::format("{} {}: robot {} is out of range, the scene has {}", option,
                                                text_of(one), one.robot, robot_count_text(document.robots.size())));
        continue;
      }
      LiveRobot& body = document.robots[one.robot].body;
      const std::vector<std::string> names = names_of(*body.robot);
      const auto found = std::ranges::find(names, one.name);
      if (found == names.end()) {
        report(Severity::warning,
               fmt::format("{} {}: {} has no {} \"{}\"", option, text_of(one), body.name, what, one.name));
        continue;
      }
      changed = hold(body, list, names.size(), static_cast<std::size_t>(found - names.begin()), one.value) || changed;
    }
  };
  hold_all(to_hold.drives, "drive", "actuator", &ByHand::drives, actuator_names);
  hold_all(to_hold.neurons, "neuron", "neuron", &ByHand::neurons, neuron_names);
  return changed;
}

void LiveScene::release_actuators(const std::vector<RobotId>& robots) {
  end_edit();
  parts_->change_robots(robots, "release actuators", {},
                        [](DocumentRobot& robot) { return release(robot.body, &ByHand::drives); });
}

void LiveScene::clamp_neuron(RobotId robot, std::size_t neuron, std::optional<float> value) {
  parts_->change_robots(
      {robot}, value ? "hold a neuron" : "release a neuron", fmt::format("neuron {}", neuron), [&](DocumentRobot& one) {
        const std::size_t count = one.body.robot->brain ? brain_layout(*one.body.robot).neurons.size() : 0;
        return neuron < count && hold(one.body, &ByHand::neurons, count, neuron, value);
      });
}

void LiveScene::release_neurons(RobotId robot) {
  end_edit();
  parts_->change_robots({robot}, "release neurons", {},
                        [](DocumentRobot& one) { return release(one.body, &ByHand::neurons); });
}

const ViewSettings& LiveScene::view() const { return parts_->view; }
void LiveScene::set_view(const ViewSettings& settings) {
  const bool details_changed =
      settings.color != parts_->view.color || settings.shown.arrows != parts_->view.shown.arrows ||
      settings.folding != parts_->view.folding || settings.footprints != parts_->view.footprints;
  const bool compares = settings.compare != parts_->view.compare;
  parts_->view = settings;
  if (details_changed) parts_->physics.set_view(settings);
  if (compares) parts_->physics.set_second(settings.compare);
}

bool LiveScene::has_voxels(RobotId robot) const {
  const DocumentRobot* found = parts_->document.find(robot);
  try {
    return found && voxel_grid_of(*found->body.robot);
  } catch (const InputError&) {
    return false;  // an origin that holds no valid grid
  }
}

std::optional<VoxelSide> LiveScene::voxel_side(const Hit& hit) const {
  const DocumentRobot* robot = parts_->document.find(hit.robot);
  if (!robot || !hit.face) return std::nullopt;
  try {
    return voxel_side_of(*robot->body.robot, *hit.face);
  } catch (const InputError&) {
    return std::nullopt;  // an origin that holds no valid grid
  }
}

bool LiveScene::edit_voxel(RobotId id, const VoxelSide& side, const VoxelEdit& edit) {
  const DocumentRobot* found = parts_->document.find(id);
  if (!found) return false;
  std::shared_ptr<const Robot> changed;
  try {
    Robot robot = with_voxel(*found->body.robot, side, edit);
    validate(robot);
    if (robot.springs == found->body.robot->springs && robot.masses == found->body.robot->masses) return false;
    changed = std::make_shared<const Robot>(std::move(robot));
  } catch (const InputError& error) {
    parts_->report(Severity::warning, error.what());
    return false;
  }
  static constexpr const char* names[] = {"add a voxel", "remove a voxel", "paint a voxel"};
  parts_->edit(names[static_cast<std::size_t>(edit.tool)]);
  DocumentRobot* robot = parts_->find(id);
  robot->body.robot = std::move(changed);
  robot->body.by_hand.reset();                   // perhaps it has other actuators
  robot->source = {.file = robot->source.file};  // the seed no longer makes this robot
  // Masses have other numbers now.
  std::erase_if(parts_->document.attachments, [&](const Attachment& one) { return one.spring.robot == id; });
  parts_->apply_document();
  parts_->pulls.send();
  return true;
}

}  // namespace mercury
