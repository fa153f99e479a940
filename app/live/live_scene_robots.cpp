// SPDX-License-Identifier: Apache-2.0
// Robots that come into the window's scene: read, made at random, children of others.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "app/live/live_scene_parts.h"
#include "app/options/robot_output.h"
#include "app/recording/trajectory_layout.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/error.h"
#include "mercury/random.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

struct OpenedRobot {
  std::string file;
  Robot robot;
};

struct Opened {
  std::vector<OpenedRobot> robots;
  std::shared_ptr<const Repro> repro;  // alone, in place of all
  fs::path repro_file;
};

// Files, and those in folders by name; what is no robot's file is told when it is read.
std::vector<fs::path> files_of(const std::vector<fs::path>& paths, Messages& messages) {
  std::vector<fs::path> files;
  for (const fs::path& path : paths) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
      files.push_back(path);
      continue;
    }
    std::vector<fs::path> inside;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
      const fs::path extension = entry->path().extension();
      std::error_code ignored;
      if ((extension == ".json" || extension == ".cbor") && !entry->is_directory(ignored))
        inside.push_back(entry->path());
    }
    if (error)
      messages.add(Severity::error, path.string() + ": " + error.message());
    else if (inside.empty())
      messages.add(Severity::warning, path.string() + ": the folder holds no robot, neither *.json nor *.cbor");
    std::ranges::sort(inside);
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

// A recording's robots, at rest.
void read_recording(const fs::path& file, Opened& opened, Messages& messages) {
  const TrajectoryReader recording(file);
  for (const RecordedRobot& recorded : recording.robots()) opened.robots.push_back({"", recorded.robot});
  messages.add(Severity::note, fmt::format("{}: the recording's {}, at rest; mercury render plays it", file.string(),
                                           robots_counted(recording.robots().size())));
}

void read_file(const fs::path& file, bool alone, Opened& opened, Messages& messages) {
  if (is_repro_name(file)) {
    if (!alone) throw InputError(file.string(), "is a repro, which has a time of its own; open it alone");
    opened.repro = std::make_shared<const Repro>(load_repro(file));
    opened.repro_file = file;
    return;
  }
  if (is_trajectory_name(file.string())) {
    read_recording(file, opened, messages);
    return;
  }
  if (file.extension() == ".toml")
    throw InputError(file.string(), "holds options, not robots; give it to mercury view --config");
  opened.robots.push_back({file.string(), load_robot(file)});
}

// What one of many files is no use for, one line each; of many the first ones.
void tell_failures(const std::vector<std::string>& failures, Messages& messages) {
  constexpr std::size_t most = 4;
  const std::size_t told = failures.size() > most ? most - 1 : failures.size();
  for (std::size_t i = 0; i < told; ++i) messages.add(Severity::error, failures[i]);
  if (told < failures.size())
    messages.add(Severity::error, fmt::format("and {} more files cannot be used", failures.size() - told));
}

Opened read_robots(const std::vector<fs::path>& files, WorkControl& control, Messages& messages) {
  Opened opened;
  std::vector<std::string> failures;
  std::int64_t done = 0;
  for (const fs::path& file : files) {
    if (control.cancelled()) break;
    try {
      read_file(file, files.size() == 1, opened, messages);
    } catch (const InputError& error) {
      failures.emplace_back(error.what());
    }
    control.progress(++done);
  }
  tell_failures(failures, messages);
  return opened;
}

struct GrownRobot {
  std::uint64_t index;
  Robot robot;
};

std::vector<GrownRobot> grow_robots(const RandomRobots& generation, WorkControl& control, Messages& messages) {
  const Generator& generator = generator_named(generation.kind);
  generator.validate(generation.values);
  const MakeRobot make = [&](std::uint64_t seed, std::uint64_t index) {
    return generator.make(generation.values, generation.environment, seed, index);
  };
  constexpr std::size_t portion = 8;
  std::vector<GrownRobot> grown;
  for (std::size_t done = 0; done < generation.count && !control.cancelled();) {
    const std::size_t count = std::min(portion, generation.count - done);
    std::vector<MadeRobot> made = make_robots(make, generation.seed, generation.first + done, count);
    for (std::size_t i = 0; i < count; ++i) {
      if (made[i].robot)
        grown.push_back({generation.first + done + i, std::move(*made[i].robot)});
      else
        messages.add(Severity::warning, "a robot was left out: " + made[i].failure);
    }
    done += count;
    control.progress(static_cast<std::int64_t>(done));
  }
  return grown;
}

}  // namespace

RobotId LiveScene::Parts::append(Robot robot, RobotSource source) {
  const RobotId id = ++last_id;
  LiveRobot body{.id = id, .name = robot.name.empty() ? "robot" : robot.name};
  body.robot = std::make_shared<const Robot>(std::move(robot));
  if (!source.file.empty()) saved[id] = {source.file, body};
  document.robots.push_back({std::move(body), std::move(source)});
  return id;
}

void LiveScene::add(std::vector<Robot> robots, bool unsaved) {
  std::erase_if(robots, [&](const Robot& robot) {
    try {
      validate(robot);
      return false;
    } catch (const InputError& error) {
      parts_->say(Severity::error, (robot.name.empty() ? "robot" : robot.name) + ": " + error.what());
      return true;
    }
  });
  if (robots.empty()) return;
  parts_->edit("add " + robots_counted(robots.size()));
  for (Robot& robot : robots) {
    const RobotId id = parts_->append(std::move(robot), {});
    if (!unsaved) parts_->saved[id] = {"", parts_->document.robots.back().body};
  }
  parts_->told();
}

void LiveScene::open(const std::vector<fs::path>& paths) {
  if (paths.empty()) return;
  Parts& parts = *parts_;
  const std::string name = paths.size() == 1 ? "opening " + paths.front().filename().string()
                                             : fmt::format("opening {} files", paths.size());
  parts.background.begin(name, 0, [&parts, paths](WorkControl& control) -> Background::Finish {
    auto opened = std::make_shared<Opened>(read_robots(files_of(paths, parts.messages), control, parts.messages));
    return [&parts, opened] {
      if (opened->repro) parts.replay(opened->repro, opened->repro_file);
      if (opened->robots.empty()) return;
      parts.edit("open " + robots_counted(opened->robots.size()));
      for (OpenedRobot& robot : opened->robots) parts.append(std::move(robot.robot), {.file = robot.file});
      parts.told();
    };
  });
}

void LiveScene::Parts::replay(const std::shared_ptr<const Repro>& repro, const fs::path& file) {
  edit("open " + file.filename().string());
  document.robots.clear();
  const Device device = document.configuration.device;
  document.configuration = repro->configuration;
  document.configuration.device = device;
  const RobotId id = append(repro->robot, {});
  saved[id] = {"", document.robots.back().body};
  physics.set_repro(document.robots.back().body, document.configuration, repro);
  say(Severity::note, fmt::format("{} explodes at {:.4g} s; here it is {:.4g} s. What was changed on the way happens "
                                  "again until you change something.",
                                  document.robots.back().body.name, repro->exploded_at, time_of(repro->clock)));
  if (repro->device_name != physics.device_name())
    say(Severity::warning, fmt::format("it was seen on {}; here it may go another way", repro->device_name));
}

void LiveScene::generate(const RandomRobots& generation, bool replace) {
  if (generation.count == 0) return;
  Parts& parts = *parts_;
  const auto order = std::make_shared<const RandomRobots>(generation);
  parts.background.begin("making " + robots_counted(generation.count), static_cast<std::int64_t>(generation.count),
                         [&parts, order, replace](WorkControl& control) -> Background::Finish {
                           auto grown =
                               std::make_shared<std::vector<GrownRobot>>(grow_robots(*order, control, parts.messages));
                           return [&parts, order, replace, grown] {
                             if (grown->empty()) return;
                             parts.edit("make " + robots_counted(grown->size()));
                             if (replace) parts.document.robots.clear();
                             for (GrownRobot& robot : *grown)
                               parts.append(std::move(robot.robot), {.generation = order, .index = robot.index});
                             parts.told();
                           };
                         });
}

bool LiveScene::can_mutate(RobotId robot) const {
  const DocumentRobot* found = parts_->document.find(robot);
  if (!found) return false;
  return generator_of(*found->body.robot) != nullptr;
}

void LiveScene::mutate(const std::vector<RobotId>& robots, const MutationRequest& mutation, bool replace) {
  Parts& parts = *parts_;
  auto parents = std::make_shared<std::vector<DocumentRobot>>();
  for (const RobotId id : robots)
    if (const DocumentRobot* robot = parts.document.find(id)) parents->push_back(*robot);
  if (parents->empty()) return;
  const auto count = static_cast<std::int64_t>(parents->size());
  parts.background.begin("mutating " + robots_counted(parents->size()), count,
                         [&parts, parents, mutation, replace](WorkControl& control) -> Background::Finish {
                           auto children = std::make_shared<std::vector<std::pair<RobotId, Robot>>>();
                           for (std::size_t i = 0; i < parents->size() && !control.cancelled(); ++i) {
                             try {
                               const Robot parent = whole_robot((*parents)[i]);
                               const MutationRequest own{mutation.strength, seed_of(mutation.seed, i)};
                               children->emplace_back((*parents)[i].body.id,
                                                      mutate_robot(parent, own, parent.name + "-child"));
                             } catch (const InputError& error) {
                               parts.messages.add(Severity::warning, error.what());
                             }
                             control.progress(static_cast<std::int64_t>(i + 1));
                           }
                           return [&parts, children, replace] {
                             if (children->empty()) return;
                             parts.edit("mutate " + robots_counted(children->size()));
                             for (auto& [parent, child] : *children) parts.put_child(parent, std::move(child), replace);
                             parts.told();
                           };
                         });
}

void LiveScene::Parts::put_child(RobotId parent, Robot child, bool replace) {
  child.name = free_name(child.name);
  append(std::move(child), {});
  if (!replace) return;
  const auto place =
      std::ranges::find_if(document.robots, [&](const DocumentRobot& robot) { return robot.body.id == parent; });
  if (place == document.robots.end()) return;
  *place = std::move(document.robots.back());
  document.robots.pop_back();
}

}  // namespace mercury
