// How fast groups are drawn: bench_render_frames [name=value ...], one line of results.
// Names: bodies side width height quality frames read (none, rgb, yuv) upload (0, 1: positions through the host)
// context
//
// Bodies are full lattices of side^3 voxels, as in the simulator's own benchmark: side 10 has 1,331 masses, 14,230
// springs and 1,200 faces. Positions stand still; everything that depends on them is computed anew in each frame.
#include <epoxy/gl.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "render/readback.h"
#include "render/renderer.h"

namespace {

using namespace mercury::render;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Lattice {
  std::vector<float> masses;
  std::vector<std::uint32_t> faces, springs;
};

Lattice make_lattice(int side) {
  Lattice lattice;
  const int n = side + 1;
  const auto mass = [&](int x, int y, int z) { return std::uint32_t((z * n + y) * n + x); };
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (const int i : {x, y, z}) lattice.masses.push_back(0.1f * float(i));
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (int d = 1; d < 27; ++d) {  // the half of the neighbours that comes later
          const int dx = d % 3 - 1, dy = (d / 3) % 3 - 1, dz = d / 9 - 1;
          if (dz * 9 + dy * 3 + dx <= 0) continue;
          const int a = x + dx, b = y + dy, c = z + dz;
          if (a >= 0 && b >= 0 && c >= 0 && a < n && b < n && c < n)
            lattice.springs.insert(lattice.springs.end(), {mass(x, y, z), mass(a, b, c)});
        }
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const auto quad = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
        lattice.faces.insert(lattice.faces.end(), {p, q, r, p, r, s});
      };
      quad(mass(i, j, 0), mass(i, j + 1, 0), mass(i + 1, j + 1, 0), mass(i + 1, j, 0));
      quad(mass(i, j, side), mass(i + 1, j, side), mass(i + 1, j + 1, side), mass(i, j + 1, side));
      quad(mass(i, 0, j), mass(i + 1, 0, j), mass(i + 1, 0, j + 1), mass(i, 0, j + 1));
      quad(mass(i, side, j), mass(i, side, j + 1), mass(i + 1, side, j + 1), mass(i + 1, side, j));
      quad(mass(0, i, j), mass(0, i, j + 1), mass(0, i + 1, j + 1), mass(0, i + 1, j));
      quad(mass(side, i, j), mass(side, i + 1, j), mass(side, i + 1, j + 1), mass(side, i, j + 1));
    }
  return lattice;
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, std::string> set{{"bodies", "12"},  {"side", "10"},      {"width", "1280"},
                                         {"height", "720"}, {"frames", "30"},    {"read", "yuv"},
                                         {"upload", "1"},   {"quality", "auto"}, {"context", "auto"}};
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    set[argument.substr(0, argument.find('='))] = argument.substr(argument.find('=') + 1);
  }
  const auto number = [&](const char* name) { return std::atoi(set[name].c_str()); };
  const auto context = make_context({.kind = context_kind_named(set["context"])});
  Renderer renderer(*context, {number("width"), number("height"), quality_named(set["quality"]), 0});

  const int bodies = number("bodies"), side = number("side");
  const Lattice lattice = make_lattice(side);
  const double begin_setup = now();
  renderer.set_bodies(
      std::vector<Body>(std::size_t(bodies), Body{lattice.masses, lattice.faces, lattice.springs, {}, {}}));
  const double setup = now() - begin_setup;

  std::vector<Placement> placements;
  const int columns = int(std::ceil(std::sqrt(1.6 * bodies)));
  const float spacing = 0.16f * float(side);
  Bounds group;
  for (int i = 0; i < bodies; ++i) {
    placements.push_back({.offset = {spacing * float(i % columns), spacing * float(i / columns), 0}});
    group.extend(bounds_of(lattice.masses).moved(placements.back().offset));
  }
  std::vector<float> positions;
  for (int i = 0; i < bodies && number("upload"); ++i)
    positions.insert(positions.end(), lattice.masses.begin(), lattice.masses.end());
  const std::vector<Look> looks{{muscle_color(0, 0.5f), 0.3f}};
  Scene scene;
  scene.positions = positions;
  scene.placements = placements;
  scene.looks = looks;
  scene.floor = -0.1f * float(side);
  Orbit orbit{.elevation = 0.7f};
  orbit.frame(group, float(renderer.width()) / float(renderer.height()));

  const PixelFormat format = set["read"] == "rgb" ? PixelFormat::rgb : PixelFormat::yuv420;
  Readback readback(format, renderer.width(), renderer.height());
  Image image;
  const int warm_up = 3, frames = number("frames");
  double begin = 0;
  for (int i = 0; i < warm_up + frames; ++i) {
    if (i == warm_up) {
      glFinish();
      begin = now();
    }
    scene.time = i / 60.0;
    renderer.draw(scene, orbit.camera());
    if (set["read"] == "none") continue;
    if (readback.full()) readback.finish(image);
    readback.start(renderer);
  }
  glFinish();
  const double seconds = (now() - begin) / frames;
  std::printf("%s, %s: %d bodies of %zu masses, %dx%d, read %s: %.2f ms a frame, %.1f frames/s (set up in %.2f s)\n",
              context->describe().c_str(), std::string(name_of(renderer.quality())).c_str(), bodies,
              lattice.masses.size() / 3, renderer.width(), renderer.height(), set["read"].c_str(), 1e3 * seconds,
              1 / seconds, setup);
}
