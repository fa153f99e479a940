// SPDX-License-Identifier: Apache-2.0
// Makes robots for the window's scene in the background: random robots and children of others.
#include <algorithm>
#include <array>

#include "app/live/live_scene_parts.h"
#include "app/options/robot_output.h"
#include "mercury/error.h"
#include "mercury/random.h"

namespace mercury {
namespace {

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

void LiveScene::generate(const RandomRobots& generation, bool replace) {
  if (generation.count == 0) return;
  Parts& parts = *parts_;
  const auto request = std::make_shared<const RandomRobots>(generation);
  const auto task = [&parts, request, replace](WorkControl& control) -> Background::Finish {
    auto made = std::make_shared<std::vector<RandomRobot>>(make_random_robots(*request, control, parts.messages));
    return [&parts, request, replace, made] {
      if (made->empty()) return;
      parts.edit("make " + robot_count_text(made->size()));
      if (replace) parts.document.robots.clear();
      for (RandomRobot& robot : *made)
        parts.append(std::move(robot.robot), {.generation = request, .index = robot.index});
      parts.apply_document();
    };
  };
  parts.background.begin("making " + robot_count_text(generation.count), static_cast<std::int64_t>(generation.count),
                         task);
}

bool LiveScene::can_mutate(RobotId robot) const {
  const DocumentRobot* found = parts_->document.find(robot);
  return found && generator_of(*found->body.robot) != nullptr;
}

void LiveScene::mutate(const std::vector<RobotId>& robots, const MutationRequest& mutation, bool replace) {
  Parts& parts = *parts_;
  auto parents = std::make_shared<std::vector<DocumentRobot>>();
  for (const RobotId id : robots)
    if (const DocumentRobot* robot = parts.document.find(id)) parents->push_back(*robot);
  if (parents->empty()) return;
  const auto task = [&parts, parents, mutation, replace](WorkControl& control) -> Background::Finish {
    auto children = std::make_shared<std::vector<Child>>(make_children(*parents, mutation, control, parts.messages));
    return [&parts, children, replace] {
      if (children->empty()) return;
      parts.edit("mutate " + robot_count_text(children->size()));
      for (Child& child : *children) parts.place_child(child.parent, std::move(child.robot), replace);
      parts.apply_document();
    };
  };
  parts.background.begin("mutating " + robot_count_text(parents->size()), static_cast<std::int64_t>(parents->size()),
                         task);
}

void LiveScene::breed(RobotId a, RobotId b, std::uint64_t seed) {
  Parts& parts = *parts_;
  const DocumentRobot *first = parts.document.find(a), *second = parts.document.find(b);
  if (!first || !second) return;
  const auto parents =
      std::make_shared<const std::array<Robot, 2>>(std::array<Robot, 2>{whole_robot(*first), whole_robot(*second)});
  const LiveRobot body = first->body;
  const auto task = [&parts, parents, body, seed](WorkControl&) -> Background::Finish {
    std::shared_ptr<Robot> child;
    try {
      const auto& [mother, father] = *parents;
      child = std::make_shared<Robot>(cross_robots(mother, father, seed, mother.name + "-x"));
    } catch (const InputError& error) {
      parts.messages.add(Severity::warning, error.what());
    }
    return [&parts, body, child] {
      if (!child) return;
      parts.edit("breed a robot");
      parts.place_child(body, std::move(*child), false);
      parts.apply_document();
    };
  };
  parts.background.begin("breeding a robot", 1, task);
}

// Adds a child at the end of the list, or in its parent's place.
void LiveScene::Parts::place_child(const LiveRobot& parent, Robot child, bool replace) {
  child.name = free_name(child.name);
  append(std::move(child), {});
  document.robots.back().parent = std::make_shared<const LiveRobot>(parent);
  if (!replace) return;
  const auto place =
      std::ranges::find_if(document.robots, [&](const DocumentRobot& robot) { return robot.body.id == parent.id; });
  if (place == document.robots.end()) return;
  *place = std::move(document.robots.back());
  document.robots.pop_back();
}

}  // namespace mercury
