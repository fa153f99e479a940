// SPDX-License-Identifier: Apache-2.0
// Films and pictures of an evolution: which of its individuals they show, and what is written beside them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "app/scene/board.h"
#include "mercury/run_folder.h"

namespace mercury {

// Robots that are filmed together.
struct Clip {
  std::vector<std::shared_ptr<const Robot>> robots;
  std::vector<std::string> captions;  // one per robot; empty = their names
  std::string title;                  // in the upper left corner; further lines are smaller
  float zoom = 1;                     // of the camera
};

struct RunFilm {
  std::vector<Clip> clips;             // one after another
  std::shared_ptr<const Board> board;  // of the only clip, or nothing
  std::vector<std::string> notes;
  std::vector<std::uint64_t> ids;  // of the robots of all clips in the run
};

class RunFilmOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(const Command& command);

  // Throws InputError for options that do not go together.
  void validate() const;
  bool map() const { return map_; }
  bool row() const { return !generations_.empty(); }
  bool lineage() const { return !lineage_.empty(); }
  // The first option that was given; empty = none. All of them need a run.
  std::string given() const;

  struct Room {
    bool at_once = false;        // a lineage as one clip
    std::size_t most_clips = 0;  // 0 = no limit
  };
  // Throws InputError for an individual, a generation or a map that the run does not have.
  RunFilm film(const RunHistory& run, const Room& room) const;

 private:
  std::string lineage_, generations_;
  std::optional<std::size_t> ancestors_, best_;
  bool map_ = false;
};

// What a robot did, as in "0.731 m" or "score 12.4": its scores, or why it has none.
std::string score_text(const RunSettings& settings, const Individual& individual);

// A number with three digits that count, but no exponent below a million.
std::string number_text(double value);

// The name of a run for titles: the last part of its path.
std::string name_of_run(const RunHistory& run);

}  // namespace mercury
