// SPDX-License-Identifier: Apache-2.0
// How fast groups are drawn, and the GPU time of each part of a picture: bench_render_frames [name=value ...].
// Names: bodies side width height frames quality (auto, low, medium, high) context (auto, egl, mesa, osmesa)
//        around (water, land, none) cover (0, 1: plants and stones) rounded (0, 1) read (none, rgb, yuv) upload (0, 1:
//        positions through the host) json (0, 1)
//
// Bodies are full lattices of side^3 voxels, as in the simulator's own benchmark: side 10 has 1,331 masses, 14,230
// springs and 1,200 faces. Positions do not change, but everything that depends on them is computed in each frame.
#include <epoxy/gl.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "bench/named_values.h"
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
        for (int d = 1; d < 27; ++d) {  // the half of the neighbors with higher indices
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

struct Options {
  std::map<std::string, std::string> set{
      {"bodies", "1000"}, {"side", "10"},   {"width", "1920"},   {"height", "1080"},  {"frames", "60"},
      {"read", "yuv"},    {"upload", "1"},  {"quality", "auto"}, {"context", "auto"}, {"around", "water"},
      {"cover", "1"},     {"rounded", "0"}, {"json", "0"}};
  int number(const char* name) const { return std::atoi(set.at(name).c_str()); }
  const std::string& text(const char* name) const { return set.at(name); }
};

Options options_of(int argc, char** argv) {
  Options options;
  mercury::set_named_values(options.set, argc, argv);
  return options;
}

// Lattices side by side, seen from above at an angle.
struct Group {
  Group(const Lattice& lattice, int bodies, int side, const std::string& around) {
    const int columns = int(std::ceil(std::sqrt(1.6 * bodies)));
    const float spacing = 0.16f * float(side);
    for (int i = 0; i < bodies; ++i) {
      placements.push_back({.offset = {spacing * float(i % columns), spacing * float(i / columns), 0}});
      box.extend(bounds_of(lattice.masses).moved(placements.back().offset));
      positions.insert(positions.end(), lattice.masses.begin(), lattice.masses.end());
    }
    scene.placements = placements;
    scene.materials = materials;
    scene.surroundings = around == "land"   ? Surroundings::land
                         : around == "none" ? Surroundings::none
                                            : Surroundings::water;
    scene.floor = scene.surroundings == Surroundings::land ? 0 : -0.1f * float(side);
  }
  std::vector<Placement> placements;
  std::vector<float> positions;
  std::vector<RenderMaterial> materials{{muscle_color(0, 0.5f), 0.3f}};
  Bounds box;
  Scene scene;
};

// The mean time of each part, over the pictures whose times arrived.
class MeanTimes {
 public:
  void add(const std::vector<PassTime>& times) {
    if (times.empty()) return;
    ++count_;
    sums_.resize(times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
      sums_[i].name = times[i].name;
      sums_[i].milliseconds += times[i].milliseconds;
    }
  }
  std::vector<PassTime> means() const {
    std::vector<PassTime> means = sums_;
    for (PassTime& part : means) part.milliseconds /= count_;
    return means;
  }

 private:
  std::vector<PassTime> sums_;
  int count_ = 0;
};

struct Result {
  double setup = 0, seconds = 0;  // of set_bodies; per picture
  std::vector<PassTime> parts;
};

Result measure(const Options& options, Renderer& renderer, const Lattice& lattice) {
  Result result;
  const int bodies = options.number("bodies"), side = options.number("side"), frames = options.number("frames");
  const double begin_setup = now();
  renderer.set_bodies(
      std::vector<Body>(std::size_t(bodies), Body{lattice.masses, lattice.faces, lattice.springs, {}, {}}));
  result.setup = now() - begin_setup;
  Group group(lattice, bodies, side, options.text("around"));
  if (options.number("cover")) group.scene.ground_cover = GroundCover{.height = 0.04f * float(side)};
  group.scene.rounded = options.number("rounded") != 0;
  if (options.number("upload")) group.scene.positions = group.positions;
  Orbit orbit{.elevation = 0.7f};
  orbit.frame(group.box, float(renderer.width()) / float(renderer.height()));
  const std::string& read = options.text("read");
  const PixelFormat format = read == "rgb" ? PixelFormat::rgb : PixelFormat::yuv420;
  Readback readback(format, renderer.width(), renderer.height());
  Image image;
  MeanTimes times;
  constexpr int warm_up = 8;
  double begin = 0;
  for (int i = 0; i < warm_up + frames; ++i) {
    if (i == warm_up) {
      glFinish();
      begin = now();
    }
    group.scene.time = i / 60.0;
    renderer.draw(group.scene, orbit.camera());
    if (i >= warm_up) times.add(renderer.times());
    if (read == "none") continue;
    if (readback.full()) readback.finish(image);
    readback.start(renderer);
  }
  glFinish();
  result.seconds = (now() - begin) / frames;
  result.parts = times.means();
  return result;
}

void print_text(const Options& o, const Context& context, const Renderer& renderer, const Lattice& lattice,
                const Result& result) {
  std::printf(
      "%s, %s quality: %d bodies of %zu masses, %dx%d, read %s: %.2f ms per frame, %.1f frames/s (set up in %.2f "
      "s)\n",
      context.describe().c_str(), std::string(name_of(renderer.quality())).c_str(), o.number("bodies"),
      lattice.masses.size() / 3, renderer.width(), renderer.height(), o.text("read").c_str(), 1e3 * result.seconds,
      1 / result.seconds, result.setup);
  for (const PassTime& part : result.parts) std::printf("  %-20s %8.3f ms\n", part.name.c_str(), part.milliseconds);
}

void print_json(const Options& o, const Context& context, const Renderer& renderer, const Lattice& lattice,
                const Result& result) {
  std::printf(
      "{\"drawn_with\": \"%s\", \"quality\": \"%s\", \"bodies\": %d, \"masses\": %zu, \"width\": %d, \"height\": %d, "
      "\"read\": \"%s\", \"milliseconds\": %.4f, \"pictures_a_second\": %.2f, \"parts\": {",
      context.describe().c_str(), std::string(name_of(renderer.quality())).c_str(), o.number("bodies"),
      lattice.masses.size() / 3, renderer.width(), renderer.height(), o.text("read").c_str(), 1e3 * result.seconds,
      1 / result.seconds);
  for (std::size_t i = 0; i < result.parts.size(); ++i)
    std::printf("%s\"%s\": %.4f", i ? ", " : "", result.parts[i].name.c_str(), result.parts[i].milliseconds);
  std::printf("}}\n");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = options_of(argc, argv);
    const auto context = make_context({.kind = context_kind_named(options.text("context")), .debug = false});
    Renderer renderer(*context, {.width = options.number("width"),
                                 .height = options.number("height"),
                                 .quality = quality_named(options.text("quality"))});
    const Lattice lattice = make_lattice(options.number("side"));
    const Result result = measure(options, renderer, lattice);
    (options.number("json") ? print_json : print_text)(options, *context, renderer, lattice, result);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_render_frames: %s\n", error.what());
    return 1;
  }
}
