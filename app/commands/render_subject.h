// SPDX-License-Identifier: Apache-2.0
// What mercury render films: robots to simulate, a recording to play back, a result to simulate again, or a run of an
// evolution.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/commands/run_film.h"
#include "app/options/output_options.h"
#include "app/options/result_file.h"
#include "app/options/robot_options.h"
#include "app/options/simulation_options.h"
#include "app/options/trial_start.h"
#include "app/options/video_options.h"
#include "app/options/view_options.h"
#include "app/recording/trajectory_playback.h"
#include "app/video/video_pipeline.h"

namespace mercury {

struct RenderOptions {
  RobotOptions robots;
  SimulationOptions simulation;
  TrialSettings start = one_trial();  // where robots begin
  VideoOptions video;
  ViewOptions view;
  RunFilmOptions film;
  OutputOptions output;
};

struct Subject {
  Configuration configuration;
  std::vector<Clip> clips;                              // one after another
  std::shared_ptr<TrajectoryReader> recording;          // of the only clip, which has no robots then; or nothing
  std::shared_ptr<const RunResult> result;              // that names the robots of the only clip, or nothing
  std::vector<std::shared_ptr<const Robot>> of_result;  // its robots
  double seconds = 0;                                   // of each clip
  TrialStart start;                                     // where robots begin
  std::vector<std::string> notes;
  std::string title;            // above it, if there are others
  std::vector<Subject> others;  // beside it, each of one clip; empty = none

  // What is filmed of a clip, from left to right: it, and what is beside it.
  std::vector<FilmedGroup> groups_of(const Clip& clip, const ViewSettings& view) const;
  // Simulates the results, and compares: check_again() of this and the others. Returns whether none differs.
  bool check_results() const;
  // What pictures of a clip say of it: VideoSettings::comment.
  std::string comment(const Clip& clip) const;

 private:
  Simulation simulation(const Configuration& in, const Clip& clip) const;
};

// What the options ask for, checked before expensive work begins.
struct RenderTask {
  Subject subject;
  VideoOptions::Plan plan;  // of each clip
  ViewSettings view;
};

// Throws InputError for options that cannot be used, whatever is filmed. May change options that have another default
// for this subject. Call it first.
void check_options(RenderOptions& options);

// Reads what is filmed. Throws InputError.
RenderTask render_task(RenderOptions& options);

}  // namespace mercury
