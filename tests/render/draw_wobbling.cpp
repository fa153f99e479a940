// Draws the wobbling group to a PNG, to look at: draw_wobbling OUT.png [name=value ...]
// Names: count side seed time frames width height quality theme around show spacing azimuth elevation context map cut
#include <chrono>
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
    {"count", "12"}, {"side", "10"},      {"seed", "1"},      {"time", "1.3"},       {"frames", "1"},
    {"width", "1280"}, {"height", "720"}, {"quality", "auto"}, {"theme", "dark"},     {"around", "water"},
    {"show", "skin"}, {"spacing", "1.25"}, {"azimuth", "-1.2"}, {"elevation", "0.6"}, {"context", "auto"},
    {"map", ""},      {"cut", ""},        {"smooth", "0"}};

double number(const char* name) { return std::atof(settings[name].c_str()); }

Scene make_scene(const WobblingGroup& group) {
  Scene scene;
  scene.placements = group.placements;
  scene.theme = settings["theme"] == "light" ? Theme::light : Theme::dark;
  scene.surroundings = settings["around"] == "land" ? Surroundings::land
                       : settings["around"] == "none" ? Surroundings::none
                                                      : Surroundings::water;
  scene.show = {settings["show"].find("skin") != std::string::npos, settings["show"].find("springs") != std::string::npos,
                settings["show"].find("masses") != std::string::npos};
  if (!settings["cut"].empty()) scene.cut = CutPlane{{0, 1, 0}, float(number("cut"))};
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
  WobblingGroup group =
      make_wobbling_group(int(number("count")), int(number("side")), std::uint32_t(number("seed")), float(number("spacing")));
  for (Placement& placement : group.placements) placement.smooth = number("smooth") != 0;
  renderer.set_bodies(group.views());
  Scene scene = make_scene(group);
  Bounds bounds;
  const std::vector<Bounds> each = renderer.body_bounds();
  for (std::size_t i = 0; i < each.size(); ++i) bounds.extend(each[i].moved(group.placements[i].offset));
  scene.floor = scene.surroundings == Surroundings::land ? bounds.low.z() : bounds.low.z() - 0.6f;
  Orbit orbit;
  orbit.azimuth = float(number("azimuth"));
  orbit.elevation = float(number("elevation"));
  orbit.frame(bounds, float(renderer.width()) / float(renderer.height()));
  const int frames = int(number("frames"));
  Readback readback(PixelFormat::rgb, renderer.width(), renderer.height());
  Image image;
  double begin = seconds();
  for (int i = 0; i < frames; ++i) {
    if (i == 1) begin = seconds();
    scene.time = number("time") + i / 30.0;
    const std::vector<float> positions = group.positions(scene.time);
    const std::vector<Look> looks = wobbling_looks(scene.time);
    scene.positions = positions;
    scene.looks = looks;
    renderer.draw(scene, orbit.camera());
    if (readback.full()) readback.finish(image);
    readback.start(renderer);
  }
  while (readback.pending()) readback.finish(image);
  if (frames > 1) std::printf("%.1f ms a frame\n", 1e3 * (seconds() - begin) / (frames - 1));
  write_png(argc > 1 ? argv[1] : "wobbling.png", image);
  for (const std::string& message : context->take_messages()) std::printf("%s\n", message.c_str());
  std::printf("%zu masses, %zu faces, %zu springs\n", renderer.mass_count(), renderer.face_count(), renderer.spring_count());
}
