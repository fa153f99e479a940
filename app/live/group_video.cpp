// SPDX-License-Identifier: Apache-2.0
#include "app/live/group_video.h"

#include <exception>
#include <mutex>
#include <thread>

#include "app/video/video_pipeline.h"
#include "mercury/error.h"

namespace mercury {
namespace {

Simulation simulation_of(const std::vector<LiveRobot>& live, const Configuration& configuration) {
  std::vector<Robot> robots;
  for (const LiveRobot& robot : live) {
    robots.push_back(*robot.robot);
    robots.back().name = robot.name;
  }
  Simulation simulation(configuration, robots);
  for (std::size_t i = 0; i < live.size(); ++i) {
    if (!live[i].materials) continue;
    for (std::size_t id = 1; id < live[i].materials->size(); ++id)
      simulation.set_material(i, static_cast<MaterialId>(id), (*live[i].materials)[id]);
  }
  return simulation;
}

}  // namespace

struct GroupVideo::Parts {
  std::vector<LiveRobot> robots;
  Configuration configuration;
  ViewSettings view;
  GroupVideoOptions options;
  VideoControl control;
  mutable std::mutex mutex;
  VideoStatus status;
  std::thread thread;

  void set_state(VideoStatus::State state, const std::string& error = {}) {
    const std::lock_guard lock(mutex);
    status.state = state;
    status.error = error;
  }

  // When the state becomes "canceled", the unfinished file is already removed.
  void make() {
    try {
      set_state(write() ? VideoStatus::State::done : VideoStatus::State::canceled);
    } catch (const std::exception& error) {
      set_state(VideoStatus::State::failed, error.what());
    }
  }

  bool write() {
    const VideoKind kind = video_kind_of(options.output);
    const PictureSize size = encoded_size(kind, options.size);
    const VideoTiming timing = video_timing(options.seconds, options.speed, options.frames_per_second);
    {
      const std::lock_guard lock(mutex);
      status.total = timing.frames;
    }
    if (robots.empty()) throw InputError("there is no robot to show");
    const auto writer = open_frame_writer(
        options.output,
        {.size = size, .frames_per_second = options.frames_per_second, .expected_frames = timing.frames});
    view.speed = options.speed;
    Simulation simulation = simulation_of(robots, configuration);
    OffscreenRenderer offscreen = make_offscreen_renderer(options.context, size, options.quality);
    std::optional<Simulation> second;
    if (view.compare) second = simulation_of(robots, view.compare->over(configuration));
    VideoPipeline pipeline(offscreen, std::move(simulation), view, {}, std::move(second));
    const VideoResult result = pipeline.run(*writer, pixel_format_of(kind), timing, true, &control);
    if (control.stop || result.interrupted) return false;
    set_state(VideoStatus::State::finishing);
    writer->finish();
    return true;
  }
};

GroupVideo::GroupVideo(std::vector<LiveRobot> robots, const Configuration& configuration, const ViewSettings& view,
                       const GroupVideoOptions& options)
    : parts_(std::make_unique<Parts>()) {
  parts_->robots = std::move(robots);
  parts_->configuration = configuration;
  parts_->view = view;
  parts_->options = options;
  parts_->status.file = options.output;
  parts_->thread = std::thread([parts = parts_.get()] { parts->make(); });
}

GroupVideo::~GroupVideo() {
  cancel();
  wait();
}

VideoStatus GroupVideo::status() const {
  const std::lock_guard lock(parts_->mutex);
  VideoStatus status = parts_->status;
  status.frames = parts_->control.frames;
  return status;
}

void GroupVideo::cancel() { parts_->control.stop = true; }

void GroupVideo::wait() {
  if (parts_->thread.joinable()) parts_->thread.join();
}

}  // namespace mercury
