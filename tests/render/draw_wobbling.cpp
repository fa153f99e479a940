// SPDX-License-Identifier: Apache-2.0
// Draws the wobbling group to a PNG: draw_wobbling OUT.png [name=value ...]
// Names: count side seed time frames width height quality theme around show spacing azimuth elevation context map cut
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "render/png.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "tests/render/wobbling_bodies.h"

using namespace mercury::render;

namespace {

std::map<std::string, std::string> settings{
    {"count", "12"},   {"side", "10"},      {"seed", "1"},       {"time", "1.3"},      {"frames", "1"},
    {"width", "1280"}, {"height", "720"},   {"quality", "auto"}, {"theme", "dark"},    {"around", "water"},
    {"show", "skin"},  {"spacing", "1.25"}, {"azimuth", "-1.2"}, {"elevation", "0.6"}, {"context", "auto"},
    {"map", ""},       {"cut", ""},         {"smooth", "0"},     {"flow", "0.15"},     {"arrows", "0"},
    {"paths", "0"},    {"text", "0"}};

double number(const char* name) { return std::atof(settings[name].c_str()); }

Scene make_scene(const WobblingGroup& group) {
  Scene scene;
  scene.placements = group.placements;
  scene.flow = {float(number("flow")), 0, 0};
  scene.theme = settings["theme"] == "light" ? Theme::light : Theme::dark;
  scene.surroundings = settings["around"] == "land"   ? Surroundings::land
                       : settings["around"] == "none" ? Surroundings::none
                                                      : Surroundings::water;
  scene.show = {settings["show"].find("skin") != std::string::npos,
                settings["show"].find("springs") != std::string::npos,
                settings["show"].find("masses") != std::string::npos};
  if (!settings["cut"].empty()) scene.cut = Cut{.axis = 1, .percent = float(number("cut"))};
  return scene;
}

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

int main(int argc, char** argv) {
  for (int i = 2; i < argc; ++i) {
    const std::string argument = argv[i];
    settings[argument.substr(0, argument.find('='))] = argument.substr(argument.find('=') + 1);
  }
  const auto context = make_context({.kind = context_kind_named(settings["context"])});
  std::printf("%s\n", context->describe().c_str());
  Renderer renderer(*context, {int(number("width")), int(number("height")), quality_named(settings["quality"]), 0});
  WobblingGroup group = make_wobbling_group(int(number("count")), int(number("side")), std::uint32_t(number("seed")),
                                            float(number("spacing")));
  for (Placement& placement : group.placements) placement.smooth = number("smooth") != 0;
  renderer.set_bodies(group.views());
  Scene scene = make_scene(group);
  Bounds bounds;
  const std::vector<Bounds> each = renderer.body_bounds();
  for (std::size_t i = 0; i < each.size(); ++i) bounds.extend(each[i].moved(group.placements[i].offset));
  scene.floor = scene.surroundings == Surroundings::land ? bounds.low.z : bounds.low.z - 0.6f;
  Orbit orbit;
  orbit.azimuth = float(number("azimuth"));
  orbit.elevation = float(number("elevation"));
  std::vector<Bounds> boxes;
  for (std::size_t i = 0; i < each.size(); ++i) boxes.push_back(each[i].moved(group.placements[i].offset));
  orbit.frame(boxes, float(renderer.width()) / float(renderer.height()), 1.08f,
              {0, number("text") != 0 ? 0.12f : 0, 0, number("text") != 0 ? 0.05f : 0});
  const int frames = int(number("frames"));
  Readback readback(PixelFormat::rgb, renderer.width(), renderer.height());
  Image image;
  double begin = seconds();
  for (int i = 0; i < frames; ++i) {
    if (i == 1) begin = seconds();
    scene.time = number("time") + i / 30.0;
    const std::vector<float> positions = group.positions(scene.time);
    const std::vector<RenderMaterial> materials = wobbling_materials(scene.time);
    scene.positions = positions;
    scene.materials = materials;
    std::vector<float> values;
    if (!settings["map"].empty()) {
      for (std::size_t m = 0; m < positions.size() / 3; ++m) values.push_back(positions[3 * m]);
      scene.mass_values = values;
      scene.scale = {-0.5f, 0.5f, colormap_named(settings["map"])};
    }
    std::vector<Arrow> arrows;
    std::vector<std::vector<float>> ways(group.bodies.size());
    std::vector<Path> paths;
    for (std::uint32_t b = 0; b < group.bodies.size(); ++b) {
      if (number("arrows") != 0)
        for (std::size_t m = renderer.mass_offsets()[b]; m < renderer.mass_offsets()[b + 1]; m += 7) {
          const Vector3 at(positions.data() + 3 * m);
          arrows.push_back({b, at, 0.4f * at, rgb(m % 2 ? 0xffb000 : 0x56b4e9)});
        }
      for (float t = 0; t < 2; t += 0.02f)
        ways[b].insert(ways[b].end(), {t - 2, 0.2f * std::sin(5 * t), 0.1f * std::cos(4 * t)});
      if (number("paths") != 0) paths.push_back({b, ways[b], category_color(int(b))});
    }
    scene.arrows = arrows;
    scene.paths = paths;
    std::vector<Label> labels;
    if (number("text") != 0) {
      for (std::uint32_t b = 0; b < group.bodies.size(); ++b)
        labels.push_back({b, "robot " + std::to_string(b + 1) + "\n1.2 m \u00b7 #" + std::to_string(b + 1)});
      scene.clock = "12.3 s   \u00d74";
      scene.caption = "Mercury\n12 random voxel robots, \u03c6 = \u03c0/2";
      scene.scale_bar = true;
      scene.legend = Legend{"speed",
                            "m/s",
                            Scale{-0.5f, 0.5f, colormap_named(settings["map"].empty() ? "viridis" : settings["map"])},
                            {}};
      if (settings["map"].empty())
        scene.legend = Legend{"material",
                              "",
                              {},
                              {{muscle_color(0, 0.5f), "muscle, \u03c6 = 0"},
                               {muscle_color(1.57f, 0.5f), "muscle, \u03c6 = \u03c0/2"},
                               {tissue_color, "tissue"},
                               {bone_color, "bone"}}};
    }
    scene.labels = labels;
    renderer.draw(scene, orbit.camera());
    if (readback.full()) readback.finish(image);
    readback.start(renderer);
  }
  while (readback.pending()) readback.finish(image);
  if (frames > 1) std::printf("%.1f ms a frame\n", 1e3 * (seconds() - begin) / (frames - 1));
  write_png(argc > 1 ? argv[1] : "wobbling.png", image);
  for (const std::string& message : context->take_messages()) std::printf("%s\n", message.c_str());
  for (const PassTime& part : renderer.times()) std::printf("%s %.1f ms, ", part.name.c_str(), part.milliseconds);
  std::printf("%zu masses, %zu faces, %zu springs\n", renderer.mass_count(), renderer.face_count(),
              renderer.spring_count());
}
