// SPDX-License-Identifier: Apache-2.0
// How fast a video of a group is made, and which part limits it: bench_export_video [name=value ...].
// Names: robots width height frames device quality gl
//        output (.mp4, .webm) crf ffmpeg json (0, 1)
//
// Measures each part alone and then the whole: simulating and drawing without encoding, with positions on the GPU and
// through the host; encoding pictures that are kept in memory; and the whole export.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/video/video_pipeline.h"
#include "bench/named_values.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"
#include "mercury/stopwatch.h"

namespace {

using namespace mercury;

using Options = std::map<std::string, std::string>;

Options options_of(int argc, char** argv) {
  Options options{{"robots", "64"},   {"width", "1920"},   {"height", "1080"}, {"frames", "300"},
                  {"device", "auto"}, {"quality", "auto"}, {"gl", "auto"},     {"output", "bench.mp4"},
                  {"ffmpeg", ""},     {"json", "0"},       {"crf", "-1"}};
  set_named_values(options, argc, argv);
  return options;
}

// Keeps some pictures and discards the others.
class Kept final : public FrameWriter {
 public:
  void write(const render::Image& frame) override {
    if (count_++ % 4 == 0 && frames.size() < 60) frames.push_back(frame);
  }
  void finish() override {}
  std::string description() const override { return "nothing"; }
  std::vector<render::Image> frames;

 private:
  std::size_t count_ = 0;
};

struct Video {
  std::vector<Robot> robots;
  Configuration configuration;
  VideoTiming timing;
  VideoSettings settings;
};

struct Made {
  double rate = 0;  // frames/s
  bool on_device = false;
};

Made make(const Video& video, OffscreenRenderer& offscreen, FrameWriter& writer, bool interop) {
  ViewSettings view;
  view.interop = interop;
  std::vector<FilmedGroup> groups;
  groups.push_back({.simulation = Simulation(video.configuration, video.robots)});
  VideoPipeline pipeline(offscreen, std::move(groups), view);
  const VideoResult result = pipeline.run(writer, render::PixelFormat::yuv420, video.timing, true);
  return {static_cast<double>(result.frames) / result.wall_seconds, pipeline.positions_on_device()};
}

double encode(const Video& video, const std::string& output, const std::vector<render::Image>& frames) {
  const auto writer = open_frame_writer(output, video.settings);
  const double begin = wall_now();
  // Forward and then backward, so that consecutive pictures differ as little as in a real video.
  const std::size_t count = frames.size();
  for (std::int64_t i = 0; i < video.timing.frames; ++i) {
    const std::size_t k = static_cast<std::size_t>(i) % (2 * count);
    writer->write(frames[k < count ? k : 2 * count - 1 - k]);
  }
  writer->finish();
  return static_cast<double>(video.timing.frames) / (wall_now() - begin);
}

int measure(const Options& options) {
  const auto number = [&](const char* name) { return std::atoi(options.at(name).c_str()); };
  Video video{.robots = random_voxel_robots({}, 1, static_cast<std::size_t>(number("robots"))),
              .timing = {.frames = number("frames"), .interval = 1.0 / 30, .pace = 1.0 / 30},
              .settings = {.size = {number("width"), number("height")},
                           .expected_frames = number("frames"),
                           .crf = number("crf") < 0 ? std::nullopt : std::optional(number("crf")),
                           .ffmpeg = options.at("ffmpeg")}};
  video.configuration.device = device_named(options.at("device"));
  const int device = video.configuration.device.kind == DeviceKind::cpu ? -1 : video.configuration.device.index;
  OffscreenRenderer offscreen =
      make_offscreen_renderer(render::context_kind_named(options.at("gl")), video.settings.size,
                              render::quality_named(options.at("quality")), device);
  Kept kept;
  {
    Video warm_up = video;
    warm_up.timing.frames = 10;
    make(warm_up, offscreen, kept, true);
    kept.frames.clear();
  }
  const Made drawn = make(video, offscreen, kept, true);
  Kept again;
  const Made through_host = make(video, offscreen, again, false);
  const std::string& output = options.at("output");
  const double encoded = encode(video, output, kept.frames);
  const auto writer = open_frame_writer(output, video.settings);
  const double begin = wall_now();
  make(video, offscreen, *writer, true);
  writer->finish();
  const double whole = static_cast<double>(video.timing.frames) / (wall_now() - begin);
  const auto bytes = static_cast<double>(std::filesystem::file_size(output));
  const char* limit = encoded < drawn.rate ? "the encoder" : "drawing and simulating";
  const char* format =
      number("json")
          ? "{\"simulated_on\": \"%s\", \"drawn_with\": \"%s\", \"quality\": \"%s\", \"encoder\": \"%s\", "
            "\"robots\": %d, "
            "\"width\": %d, \"height\": %d, \"drawn\": %.1f, \"on_device\": %d, \"drawn_through_host\": %.1f, "
            "\"encoded\": %.1f, \"exported\": %.1f, \"limit\": \"%s\", \"megabytes\": %.2f}\n"
          : "simulated on %s, drawn with %s, %s quality, encoded as %s: %d robots, %dx%d\n"
            "  simulated and drawn  %8.1f frames/s (positions on the GPU: %d)\n"
            "  ... through the host %8.1f frames/s\n"
            "  encoded alone        %8.1f frames/s\n"
            "  the whole export     %8.1f frames/s, limited by %s; %.2f MB\n";
  std::printf(format, Simulation(video.configuration, video.robots).device_name().c_str(),
              offscreen.context->describe().c_str(), std::string(name_of(offscreen.renderer.quality())).c_str(),
              writer->description().c_str(), number("robots"), video.settings.size.width, video.settings.size.height,
              drawn.rate, drawn.on_device ? 1 : 0, through_host.rate, encoded, whole, limit, bytes * 1e-6);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return measure(options_of(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_export_video: %s\n", error.what());
    return 1;
  }
}
