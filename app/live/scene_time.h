// SPDX-License-Identifier: Apache-2.0
// The time of the window's scene: playing, speed, and the timeline (timeline.h) with a loop and bookmarks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace mercury {

class SceneCore;

// What SceneTime::mark_loop() did.
enum class LoopMark { begun, closed, ended };

class SceneTime {
 public:
  explicit SceneTime(SceneCore& core) : core_(core) {}

  // Speeds are simulated seconds per second.
  void play();
  void pause();
  void toggle();
  bool playing() const { return playing_; }  // as requested; Snapshot::playing is what physics does
  void step(std::int64_t count = 1);         // pauses first
  void reset();
  void set_speed(double speed);  // clamped to 1/1000 .. 100, or unlimited_speed
  double speed() const { return speed_; }
  void change_speed(int notches);  // faster if > 0: 0.1, 0.2, 0.5, 1, 2, 5, ...
  void pause_on_explosion(bool pause);

  // Snapshot::timeline says which moments there are; times are simulated seconds. An edit while an earlier moment is
  // shown goes on from there.
  void seek(double time);
  void step_back(std::int64_t count = 1);  // pauses first
  void go_on();                            // what came after the moment shown is forgotten
  void set_loop(std::optional<std::pair<double, double>> times);
  // One key: begins a loop at the moment shown, closes it there, ends it.
  LoopMark mark_loop();
  std::optional<double> loop_begin() const;      // of a loop that is not closed yet
  const std::vector<double>& bookmarks() const;  // ascending
  bool toggle_bookmark();                        // at the moment shown; returns whether there is one now
  bool seek_bookmark(int direction);             // to the next (> 0) or previous one; false = there is none
  void set_timeline_budget(std::size_t bytes);

  // Follows the newest snapshot; LiveScene::frame() calls it.
  void update();

 private:
  SceneCore& core_;
  bool playing_ = false, pauses_on_explosion_ = false;
  std::uint64_t stops_ = 0;  // of the last snapshot
  double speed_ = 1;
};

}  // namespace mercury
