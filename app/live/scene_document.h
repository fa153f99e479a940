// SPDX-License-Identifier: Apache-2.0
// The scene as a document: what the user edits, and the history of edits.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/live/snapshot.h"
#include "app/options/attachment_options.h"
#include "mercury/generator.h"

namespace mercury {

// Factors on a robot's own materials; the phase is added [rad].
struct MaterialScale {
  float stiffness = 1, amplitude = 1, frequency = 1, phase = 0;
  friend bool operator==(const MaterialScale&, const MaterialScale&) = default;
};

// Where a robot comes from; names the robot in a command.
struct RobotProvenance {
  std::string file;                                // read from it; or empty
  std::shared_ptr<const RandomRobots> generation;  // one of these random robots; or null
  std::uint64_t index = 0;                         // of the generation
};

struct DocumentRobot {
  LiveRobot body;
  RobotProvenance source;
  // Bodies to compare it with, or null: as it was opened or made, and that which it was mutated or bred from.
  std::shared_ptr<const LiveRobot> made = nullptr, parent = nullptr;
};

// A pin or a spring that stays attached to a mass.
struct Attachment {
  LivePerturbation spring;
  std::uint64_t resets = 0;  // their number when its target was set
};

struct SceneDocument {
  std::vector<DocumentRobot> robots;
  std::vector<Attachment> attachments;
  Configuration configuration;
  TrialStart start;  // where robots begin
  // Grows with each change of environment; an undo brings the old number back, and with it the states that robots had.
  std::uint64_t surroundings = 0;

  DocumentRobot* find(RobotId id);  // null if it is unknown
  const DocumentRobot* find(RobotId id) const;
};

// What may be held of a robot by hand, in the order of ByHand.
std::vector<std::string> actuator_names(const Robot& robot);
std::vector<std::string> neuron_names(const Robot& robot);
// Holds one value of a list with `count` of them, or releases it. Returns whether that changes anything.
bool hold(LiveRobot& robot, std::vector<float> ByHand::*list, std::size_t count, std::size_t index,
          std::optional<float> wanted);
// Releases all of a list.
bool release(LiveRobot& robot, std::vector<float> ByHand::*list);

// What is held by hand, as options and scenes have it.
HeldParts held_in(const SceneDocument& document);

// "1 robot", "2 robots".
inline std::string robot_count_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " robot" : " robots");
}

// The robot with its name and materials in the window, as it is saved.
Robot whole_robot(const LiveRobot& robot);
inline Robot whole_robot(const DocumentRobot& robot) { return whole_robot(robot.body); }

// Undo and redo: the document before each edit. Documents share their robots, so an edit costs little memory unless it
// removes robots. The oldest edits are forgotten if removed robots would fill the memory.
class EditHistory {
 public:
  explicit EditHistory(std::size_t most_springs = 30'000'000) : most_springs_(most_springs) {}
  // Call it before `document` changes. An edit with the key of the previous one continues that edit, until end_edit().
  // An empty key always begins a new edit.
  void before_change(const SceneDocument& document, std::string name, std::string key = {});
  void end_edit() { open_key_.clear(); }
  void clear();
  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }
  std::string undo_name() const { return past_.empty() ? "" : past_.back().name; }
  std::string redo_name() const { return future_.empty() ? "" : future_.back().name; }
  void undo(SceneDocument& document);
  void redo(SceneDocument& document);

 private:
  struct Edit {
    std::string name;
    SceneDocument document;  // before the edit; in future_, after it
  };
  void forget_oldest(const SceneDocument& document);

  static constexpr std::size_t most = 200;  // edits
  std::size_t most_springs_;                // of all robots that only edits hold
  std::vector<Edit> past_, future_;
  std::string open_key_;
};

}  // namespace mercury
