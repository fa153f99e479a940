// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_robots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include "app/live/background.h"
#include "app/live/picking.h"
#include "app/live/saved_robots.h"
#include "app/live/scene_core.h"
#include "app/live/scene_selection.h"
#include "mercury/error.h"
#include "mercury/lively.h"
#include "mercury/random.h"

namespace mercury {
namespace {

// `wanted`, or the first of wanted-2, wanted-3, ... that no robot has.
std::string free_name(const SceneDocument& document, const std::string& wanted) {
  const auto taken = [&](const std::string& name) {
    return std::ranges::any_of(document.robots, [&](const DocumentRobot& robot) { return robot.body.name == name; });
  };
  if (!taken(wanted)) return wanted;
  for (int number = 2;; ++number)
    if (std::string name = fmt::format("{}-{}", wanted, number); !taken(name)) return name;
}

struct RandomRobot {
  std::uint64_t index;  // in the seed's sequence
  Robot robot;
};

// A robot that cannot be made is reported and left out.
std::vector<RandomRobot> make_random_robots(const RandomRobots& request, WorkControl& control, Messages& messages) {
  const Generator& generator = generator_named(request.kind);
  generator.validate(request.values);
  const MakeRobot make = [&](std::uint64_t seed, std::uint64_t index) {
    return generator.make(request.values, request.environment, seed, index);
  };
  constexpr std::size_t portion = 8;  // robots between two reports of progress
  std::vector<RandomRobot> robots;
  for (std::size_t done = 0; done < request.count && !control.canceled();) {
    const std::size_t count = std::min(portion, request.count - done);
    std::vector<MadeRobot> made = make_robots(make, request.seed, request.first + done, count);
    for (std::size_t i = 0; i < count; ++i) {
      if (made[i].robot)
        robots.push_back({request.first + done + i, std::move(*made[i].robot)});
      else
        messages.add(Severity::warning, "a robot was left out: " + made[i].failure);
    }
    done += count;
    control.progress(static_cast<std::int64_t>(done));
  }
  return robots;
}

std::vector<RandomRobot> make_lively_robots(const RandomRobots& request, const Configuration& configuration,
                                            WorkControl& control, Messages& messages) {
  const auto watch = [&](std::size_t done, std::size_t) {
    control.progress(static_cast<std::int64_t>(done / tried_per_lively));
    return !control.canceled();
  };
  std::vector<RandomRobot> robots;
  for (const RandomRobots& one : lively_requests(request, configuration, watch))
    std::ranges::move(make_random_robots(one, control, messages), std::back_inserter(robots));
  return robots;
}

struct Child {
  LiveRobot parent;
  Robot robot;
};

// One child per parent, each with its own seed. A parent that cannot be mutated is reported and left out.
std::vector<Child> make_children(const std::vector<DocumentRobot>& parents, const MutationRequest& mutation,
                                 WorkControl& control, Messages& messages) {
  std::vector<Child> children;
  for (std::size_t i = 0; i < parents.size() && !control.canceled(); ++i) {
    try {
      const Robot parent = whole_robot(parents[i]);
      MutationRequest own = mutation;
      own.seed = seed_of(mutation.seed, i);
      children.push_back({parents[i].body, mutate_robot(parent, own, parent.name + "-child")});
    } catch (const InputError& error) {
      messages.add(Severity::warning, error.what());
    }
    control.progress(static_cast<std::int64_t>(i + 1));
  }
  return children;
}

}  // namespace

std::vector<RobotEntry> SceneRobots::entries() const {
  const std::set<RobotId> selected = selection_.ids();
  std::vector<RobotEntry> entries;
  entries.reserve(core_.document().robots.size());
  for (const DocumentRobot& robot : core_.document().robots) {
    const Robot& body = *robot.body.robot;
    RobotEntry entry{.id = robot.body.id,
                     .name = robot.body.name,
                     .masses = body.masses.size(),
                     .springs = body.springs.size(),
                     .faces = body.faces.size(),
                     .file = saved_.file_of(robot.body.id).value_or(""),
                     .unsaved = !saved_.holds(robot.body),
                     .selected = selected.contains(robot.body.id),
                     .hidden = selection_.is_hidden(robot.body.id),
                     .tuned = robot.body.materials != nullptr};
    if (const auto index = core_.snapshot().robots->index_of(robot.body.id)) {
      const Telemetry& telemetry = core_.snapshot().telemetry[*index];
      entry.exploded = telemetry.exploded;
      entry.exploded_at = telemetry.exploded_at;
      entry.culprit_spring = telemetry.culprit_spring;
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::size_t SceneRobots::count() const { return core_.document().robots.size(); }

const LiveRobot& SceneRobots::append(SceneDocument& document, Robot robot, RobotProvenance source) {
  LiveRobot body{.id = ++last_id_, .name = robot.name.empty() ? "robot" : robot.name};
  body.robot = std::make_shared<const Robot>(std::move(robot));
  if (!source.file.empty()) saved_.note(body, source.file);
  auto made = std::make_shared<const LiveRobot>(body);
  return document.robots.emplace_back(std::move(body), std::move(source), std::move(made)).body;
}

void SceneRobots::remove_invalid(std::vector<Robot>& robots) const {
  std::erase_if(robots, [&](const Robot& robot) {
    try {
      validate(robot);
      return false;
    } catch (const InputError& error) {
      core_.report(Severity::error, (robot.name.empty() ? "robot" : robot.name) + ": " + error.what());
      return true;
    }
  });
}

std::vector<RobotId> SceneRobots::append_all(SceneDocument& document, std::vector<Robot> robots, bool unsaved) {
  std::vector<RobotId> ids;
  for (Robot& robot : robots) {
    const LiveRobot& body = append(document, std::move(robot));
    ids.push_back(body.id);
    if (!unsaved) saved_.note(body, "");
  }
  core_.apply_document();
  return ids;
}

std::vector<RobotId> SceneRobots::add(std::vector<Robot> robots, bool unsaved) {
  remove_invalid(robots);
  if (robots.empty()) return {};
  SceneDocument& document = core_.edit("add " + robot_count_text(robots.size()));
  return append_all(document, std::move(robots), unsaved);
}

void SceneRobots::show(std::vector<Robot> robots, const Configuration& configuration, const std::string& edit) {
  remove_invalid(robots);
  SceneDocument& document = core_.edit(edit);
  const Device device = document.configuration.device;
  document.configuration = configuration;
  document.configuration.device = device;
  document.robots.clear();
  append_all(document, std::move(robots), false);
}

void SceneRobots::remove(const std::vector<RobotId>& robots) {
  const std::set<RobotId> removed(robots.begin(), robots.end());
  const auto goes = [&](const DocumentRobot& robot) { return removed.contains(robot.body.id); };
  const auto count = std::ranges::count_if(core_.document().robots, goes);
  if (count == 0) return;
  std::erase_if(core_.edit("remove " + robot_count_text(static_cast<std::size_t>(count))).robots, goes);
  core_.apply_document();
}

void SceneRobots::clear() {
  std::vector<RobotId> all;
  for (const DocumentRobot& robot : core_.document().robots) all.push_back(robot.body.id);
  remove(all);
}

void SceneRobots::rename(RobotId robot, const std::string& name) {
  const DocumentRobot* before = core_.document().find(robot);
  if (!before || name.empty() || before->body.name == name) return;
  DocumentRobot* found = core_.edit("rename " + before->body.name).find(robot);
  if (!found) return;
  found->body.name = name;
  core_.apply_document();
}

void SceneRobots::duplicate(const std::vector<RobotId>& robots) {
  std::vector<DocumentRobot> originals;
  for (const RobotId id : robots)
    if (const DocumentRobot* robot = core_.document().find(id)) originals.push_back(*robot);
  if (originals.empty()) return;
  SceneDocument& document = core_.edit("duplicate " + robot_count_text(originals.size()));
  for (DocumentRobot& copy : originals) {
    copy.body.id = ++last_id_;
    copy.body.name = free_name(document, copy.body.name);
    document.robots.push_back(std::move(copy));
  }
  core_.apply_document();
}

std::vector<RobotId> SceneRobots::fork(const std::vector<RobotId>& robots) {
  core_.adopt_moment();
  std::vector<DocumentRobot> copies;
  for (const RobotId id : robots)
    if (const DocumentRobot* robot = core_.document().find(id)) copies.push_back(*robot);
  if (copies.empty()) return {};
  SceneDocument& document = core_.edit("fork " + robot_count_text(copies.size()));
  std::vector<RobotId> ids;
  for (DocumentRobot& copy : copies) {
    copy.body.begins_as = copy.body.id;
    copy.body.id = ++last_id_;
    copy.body.name = free_name(document, copy.body.name);
    ids.push_back(copy.body.id);
    document.robots.push_back(std::move(copy));
  }
  core_.apply_document();
  return ids;
}

void SceneRobots::generate(const RandomRobots& generation, bool replace, bool lively) {
  if (generation.count == 0) return;
  const auto request = std::make_shared<const RandomRobots>(generation);
  const std::string environment(name_of(core_.document().configuration.environment));
  const auto task = [this, request, replace, lively, environment](WorkControl& control) -> Background::Finish {
    auto made = std::make_shared<std::vector<RandomRobot>>(
        lively ? make_lively_robots(*request, lively_configuration(*request, environment), control, core_.messages())
               : make_random_robots(*request, control, core_.messages()));
    return [this, request, replace, made] {
      if (made->empty()) return;
      SceneDocument& document = core_.edit("make " + robot_count_text(made->size()));
      if (replace) document.robots.clear();
      for (RandomRobot& robot : *made)
        append(document, std::move(robot.robot), {.generation = request, .index = robot.index});
      core_.apply_document();
    };
  };
  background_.begin("making " + robot_count_text(generation.count), static_cast<std::int64_t>(generation.count), task);
}

void SceneRobots::mutate(const std::vector<RobotId>& robots, const MutationRequest& mutation, bool replace) {
  auto parents = std::make_shared<std::vector<DocumentRobot>>();
  for (const RobotId id : robots)
    if (const DocumentRobot* robot = core_.document().find(id)) parents->push_back(*robot);
  if (parents->empty()) return;
  const auto task = [this, parents, mutation, replace](WorkControl& control) -> Background::Finish {
    auto children = std::make_shared<std::vector<Child>>(make_children(*parents, mutation, control, core_.messages()));
    return [this, children, replace] {
      if (children->empty()) return;
      SceneDocument& document = core_.edit("mutate " + robot_count_text(children->size()));
      for (Child& child : *children) place_child(document, child.parent, std::move(child.robot), replace);
      core_.apply_document();
    };
  };
  background_.begin("mutating " + robot_count_text(parents->size()), static_cast<std::int64_t>(parents->size()), task);
}

void SceneRobots::breed(RobotId a, RobotId b, std::uint64_t seed) {
  const DocumentRobot *first = core_.document().find(a), *second = core_.document().find(b);
  if (!first || !second) return;
  const auto parents =
      std::make_shared<const std::array<Robot, 2>>(std::array<Robot, 2>{whole_robot(*first), whole_robot(*second)});
  const LiveRobot body = first->body;
  const auto task = [this, parents, body, seed](WorkControl&) -> Background::Finish {
    std::shared_ptr<Robot> child;
    try {
      const auto& [mother, father] = *parents;
      child = std::make_shared<Robot>(cross_robots(mother, father, seed, mother.name + "-x"));
    } catch (const InputError& error) {
      core_.messages().add(Severity::warning, error.what());
    }
    return [this, body, child] {
      if (!child) return;
      place_child(core_.edit("breed a robot"), body, std::move(*child), false);
      core_.apply_document();
    };
  };
  background_.begin("breeding a robot", 1, task);
}

void SceneRobots::place_child(SceneDocument& document, const LiveRobot& parent, Robot child, bool replace) {
  child.name = free_name(document, child.name);
  append(document, std::move(child));
  document.robots.back().parent = std::make_shared<const LiveRobot>(parent);
  if (!replace) return;
  const auto place =
      std::ranges::find_if(document.robots, [&](const DocumentRobot& robot) { return robot.body.id == parent.id; });
  if (place == document.robots.end()) return;
  *place = std::move(document.robots.back());
  document.robots.pop_back();
}

bool SceneRobots::has_voxels(RobotId robot) const {
  const DocumentRobot* found = core_.document().find(robot);
  try {
    return found && voxel_grid_of(*found->body.robot);
  } catch (const InputError&) {
    return false;  // an origin that holds no valid grid
  }
}

std::optional<VoxelSide> SceneRobots::voxel_side(const Hit& hit) const {
  const DocumentRobot* robot = core_.document().find(hit.robot);
  if (!robot || !hit.face) return std::nullopt;
  try {
    return voxel_side_of(*robot->body.robot, *hit.face);
  } catch (const InputError&) {
    return std::nullopt;  // an origin that holds no valid grid
  }
}

bool SceneRobots::edit_voxel(RobotId id, const VoxelSide& side, const VoxelEdit& edit) {
  const DocumentRobot* found = core_.document().find(id);
  if (!found) return false;
  std::shared_ptr<const Robot> changed;
  try {
    Robot robot = with_voxel(*found->body.robot, side, edit);
    validate(robot);
    if (robot.springs == found->body.robot->springs && robot.masses == found->body.robot->masses) return false;
    changed = std::make_shared<const Robot>(std::move(robot));
  } catch (const InputError& error) {
    core_.report(Severity::warning, error.what());
    return false;
  }
  static constexpr const char* names[] = {"add a voxel", "remove a voxel", "paint a voxel"};
  SceneDocument& document = core_.edit(names[static_cast<std::size_t>(edit.tool)]);
  DocumentRobot* robot = document.find(id);
  robot->body.robot = std::move(changed);
  robot->body.by_hand.reset();                   // perhaps it has other actuators
  robot->source = {.file = robot->source.file};  // the seed no longer makes this robot
  // Masses have other numbers now.
  std::erase_if(document.attachments, [&](const Attachment& one) { return one.spring.robot == id; });
  core_.apply_document();
  core_.perturbations().send();
  return true;
}

}  // namespace mercury
