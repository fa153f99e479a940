// SPDX-License-Identifier: Apache-2.0
#include "app/live/group_video.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "app/base/bounded_queue.h"
#include "app/scene/hero_style.h"
#include "app/video/contact_sheet.h"
#include "app/video/video_pipeline.h"
#include "mercury/error.h"

namespace mercury {
namespace {

constexpr std::size_t most_waiting = 8;  // frames
constexpr double longest_stay = 10;      // of one frame in the video [s]

std::uint8_t byte_of(float value) { return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L)); }

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

  // A frame, how many there are, and what writes them.
  struct Plan {
    PictureSize size;
    render::PixelFormat pixels;
    VideoTiming timing;
    std::unique_ptr<FrameWriter> writer;
  };

  Plan plan_video() const {
    const VideoKind kind = video_kind_of(options.output);
    const PictureSize size = encoded_size(kind, options.size);
    const VideoTiming timing = video_timing(options.seconds, options.speed, options.frames_per_second);
    return {size, pixel_format_of(kind), timing,
            open_frame_writer(options.output, {.size = size,
                                               .frames_per_second = options.frames_per_second,
                                               .expected_frames = timing.frames,
                                               .comment = comment_of(*robots.front().robot, configuration)})};
  }

  Plan plan_picture() const {
    return {options.size, render::PixelFormat::rgb, VideoTiming{.frames = 1, .start = *options.still},
            std::make_unique<ContactSheet>(options.output, Grid{}, options.size, 0,
                                           comment_of(*robots.front().robot, configuration))};
  }

  // The style has a camera and an arrangement of its own, and shows the robots alone.
  void become_hero() {
    view.camera = {};
    view.compare.reset();
    view.shown.clock = view.shown.path = view.shown.labels = view.shown.captions = view.shown.scale_bar = false;
    set_hero_style(view, configuration.environment);
    if (options.quality == render::Quality::automatic) options.quality = render::Quality::medium;
    std::vector<std::shared_ptr<const Robot>> bodies;
    RobotId last = 0;
    for (const LiveRobot& one : robots) {
      bodies.push_back(one.robot);
      last = std::max(last, one.id);
    }
    const std::size_t given = bodies.size();
    add_siblings(bodies, configuration.environment);
    for (std::size_t i = given; i < bodies.size(); ++i) {
      LiveRobot sibling = robots[i % given];
      sibling.robot = bodies[i];
      sibling.id = ++last;
      sibling.begins_as = 0;
      robots.push_back(std::move(sibling));
    }
  }

  bool write() {
    if (robots.empty()) throw InputError("there is no robot to show");
    Plan plan = options.still ? plan_picture() : plan_video();
    const auto& [size, pixels, timing, writer] = plan;
    {
      const std::lock_guard lock(mutex);
      status.total = timing.frames;
    }
    view.speed = options.still ? 1 : options.speed;
    if (options.still) view.aperture = options.aperture;
    if (options.still && options.hero) become_hero();
    Simulation simulation = simulation_of(robots, configuration, options.start);
    OffscreenRenderer offscreen = make_offscreen_renderer(options.context, size, options.quality);
    std::vector<FilmedGroup> groups;
    groups.push_back({std::move(simulation)});
    if (view.compare) groups.push_back({simulation_of(robots, view.compare->over(configuration), options.start)});
    VideoPipeline pipeline(offscreen, std::move(groups), view);
    const VideoResult result = pipeline.run(*writer, pixels, timing, true, &control);
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

// BT.709 with luma in 16..235 and chroma in 16..240; chroma is the mean of four pixels.
render::Image yuv420_of(const render::Image& rgb) {
  const int width = rgb.width - rgb.width % 2, height = rgb.height - rgb.height % 2;
  render::Image yuv{width, height, render::PixelFormat::yuv420, {}};
  yuv.bytes.resize(render::image_size(render::PixelFormat::yuv420, width, height));
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::uint8_t* const luma = yuv.bytes.data();
  std::uint8_t* const blue = luma + pixels;
  std::uint8_t* const red = blue + pixels / 4;
  for (int y = 0; y < height; y += 2)
    for (int x = 0; x < width; x += 2) {
      float sum[3] = {};
      for (int k = 0; k < 4; ++k) {
        const int px = x + k % 2, py = y + k / 2;
        const std::uint8_t* p =
            rgb.bytes.data() +
            3 * (static_cast<std::size_t>(py) * static_cast<std::size_t>(rgb.width) + static_cast<std::size_t>(px));
        const float r = p[0], g = p[1], b = p[2];
        luma[static_cast<std::size_t>(py) * static_cast<std::size_t>(width) + static_cast<std::size_t>(px)] =
            byte_of(16 + 219.0f / 255 * (0.2126f * r + 0.7152f * g + 0.0722f * b));
        sum[0] += r / 4;
        sum[1] += g / 4;
        sum[2] += b / 4;
      }
      const float mean = 0.2126f * sum[0] + 0.7152f * sum[1] + 0.0722f * sum[2];
      const std::size_t at =
          static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(width / 2) + static_cast<std::size_t>(x / 2);
      blue[at] = byte_of(128 + 224.0f / 255 * (sum[2] - mean) / 1.8556f);
      red[at] = byte_of(128 + 224.0f / 255 * (sum[0] - mean) / 1.5748f);
    }
  return yuv;
}

struct ScreenRecording::Parts {
  struct Waiting {
    render::Image picture;
    std::int64_t times = 1;
  };

  Parts(const std::string& output, PictureSize frame, double rate) : size(frame), frames_per_second(rate) {
    status.file = output;
  }

  const PictureSize size;
  const double frames_per_second;
  double start = 0;
  std::int64_t last = -1;  // number of the last frame taken
  BoundedQueue<Waiting> queue{most_waiting};
  std::atomic<bool> canceled = false;
  mutable std::mutex mutex;
  VideoStatus status;
  std::thread thread;

  std::int64_t number_at(double time) const {
    return last < 0 ? 0 : static_cast<std::int64_t>(std::floor((time - start) * frames_per_second + 1e-6));
  }
  void set_state(VideoStatus::State state, const std::string& error = {}) {
    const std::lock_guard lock(mutex);
    status.state = state;
    status.error = error;
  }

  // When the state becomes "canceled", the unfinished file is already removed.
  void encode(const std::string& output) {
    try {
      set_state(write(output) ? VideoStatus::State::done : VideoStatus::State::canceled);
    } catch (const std::exception& error) {
      queue.abandon();
      set_state(VideoStatus::State::failed, error.what());
    }
  }

  bool write(const std::string& output) {
    const VideoKind kind = video_kind_of(output);
    const bool yuv = pixel_format_of(kind) == render::PixelFormat::yuv420;
    const PictureSize written = yuv ? PictureSize{size.width - size.width % 2, size.height - size.height % 2} : size;
    const auto writer = open_frame_writer(output, {.size = written, .frames_per_second = frames_per_second});
    std::int64_t frames = 0;
    while (auto waiting = queue.pop()) {
      const render::Image picture = yuv ? yuv420_of(waiting->picture) : std::move(waiting->picture);
      for (std::int64_t i = 0; i < waiting->times && !canceled; ++i) {
        writer->write(picture);
        const std::lock_guard lock(mutex);
        status.frames = ++frames;
      }
    }
    if (canceled) return false;
    if (frames == 0) throw VideoError(output + ": nothing was recorded");
    writer->finish();
    return true;
  }
};

ScreenRecording::ScreenRecording(const std::string& output, PictureSize size, double frames_per_second)
    : parts_(std::make_unique<Parts>(output, size, frames_per_second)) {
  parts_->thread = std::thread([parts = parts_.get(), output] { parts->encode(output); });
}

ScreenRecording::~ScreenRecording() {
  parts_->queue.close();
  parts_->thread.join();
}

bool ScreenRecording::wants(double time) const { return parts_->number_at(time) > parts_->last; }

bool ScreenRecording::offer(double time, render::Image frame) {
  Parts& parts = *parts_;
  if (!wants(time) || frame.width != parts.size.width || frame.height != parts.size.height ||
      frame.format != render::PixelFormat::rgb)
    return false;
  const bool first = parts.last < 0;
  const std::int64_t number = parts.number_at(time);
  const auto most = static_cast<std::int64_t>(std::max(1.0, longest_stay * parts.frames_per_second));
  Parts::Waiting waiting{std::move(frame), std::min(number - parts.last, most)};
  if (!parts.queue.try_push(waiting)) {
    const std::lock_guard lock(parts.mutex);
    ++parts.status.dropped;
    return false;
  }
  if (first) parts.start = time;
  parts.last = number;
  return true;
}

void ScreenRecording::finish() {
  {
    const std::lock_guard lock(parts_->mutex);
    if (parts_->status.state == VideoStatus::State::running) parts_->status.state = VideoStatus::State::finishing;
  }
  parts_->queue.close();
}

void ScreenRecording::cancel() {
  parts_->canceled = true;
  parts_->queue.abandon();
}

VideoStatus ScreenRecording::status() const {
  const std::lock_guard lock(parts_->mutex);
  return parts_->status;
}

PictureSize ScreenRecording::size() const { return parts_->size; }

}  // namespace mercury
