// SPDX-License-Identifier: Apache-2.0
// Evolution with a genome of one's own: a worm of voxels whose muscles follow a wave. The genome is two numbers, the
// wave's length and its frequency.
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <mercury/error.h>
#include <mercury/evolution.h>
#include <mercury/random.h>
#include <mercury/voxel.h>

using mercury::GenomePointer;

struct Wave {
  float turns = 1;      // of the phase along the body
  float frequency = 3;  // [rad/s]
};

class Worm : public mercury::Genome {
 public:
  explicit Worm(const Wave& wave) : wave_(wave) {}

  mercury::Robot grow(const std::string& name) const override {
    constexpr int length = 8;
    mercury::VoxelGrid grid(length, 2, 2, mercury::tissue);
    const auto defaults = mercury::default_materials();
    std::vector<mercury::Material> bases(defaults.begin() + 1, defaults.begin() + 1 + mercury::base_material_count);
    for (int x = 0; x < length; ++x) {
      // One muscle per slice in the upper half; the lower half is tissue.
      const auto muscle = static_cast<mercury::MaterialId>(1 + x);
      for (int y = 0; y < 2; ++y) grid.cell(x, y, 1) = muscle;
      bases[static_cast<std::size_t>(x)] = {.stiffness = 200,
                                            .amplitude = 0.3f,
                                            .frequency = wave_.frequency,
                                            .phase = 6.2832f * wave_.turns * x / length};
    }
    const std::span<const mercury::Material, mercury::base_material_count> table(bases);
    return mercury::make_voxel_robot(grid, {.name = name, .materials = mercury::material_table(table)});
  }

  GenomePointer mutate(double strength, std::uint64_t seed) const override {
    mercury::Random random(seed);
    Wave child = wave_;
    child.turns += static_cast<float>(0.2 * strength * random.normal());
    child.frequency += static_cast<float>(0.5 * strength * random.normal());
    return std::make_shared<Worm>(child);
  }

  GenomePointer cross(const mercury::Genome& other, std::uint64_t seed) const override {
    const Wave& b = static_cast<const Worm&>(other).wave_;
    return std::make_shared<Worm>(mercury::Random(seed).chance(0.5) ? Wave{wave_.turns, b.frequency}
                                                                    : Wave{b.turns, wave_.frequency});
  }

  std::uint64_t identity() const override {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &wave_, sizeof wave_);
    return bits;
  }

  std::string encode() const override { return {reinterpret_cast<const char*>(&wave_), sizeof wave_}; }

  const Wave& wave() const { return wave_; }

 private:
  Wave wave_;
};

class Worms : public mercury::GenomeSpace {
 public:
  GenomePointer random(std::uint64_t seed, std::uint64_t index) const override {
    mercury::Random random(mercury::seed_of(seed, index));
    return std::make_shared<Worm>(
        Wave{static_cast<float>(random.uniform(-2, 2)), static_cast<float>(random.uniform(0.5, 6))});
  }

  GenomePointer decode(std::string_view bytes) const override {
    Wave wave;
    if (bytes.size() != sizeof wave) throw mercury::InputError("worm", "a genome has 8 bytes");
    std::memcpy(&wave, bytes.data(), sizeof wave);
    return std::make_shared<Worm>(wave);
  }
};

int main() {
  const Worms worms;
  mercury::EvolutionSettings settings;
  settings.algorithm = {.name = "ga", .population = 8};
  settings.generations = 6;
  settings.trials.seconds = 3;
  mercury::Evolution evolution(settings, worms);
  const auto assessor = mercury::make_assessor(settings);
  while (const auto generation = evolution.advance(*assessor)) {
    const mercury::Individual& best = evolution.living().front();
    const Wave& wave = static_cast<const Worm&>(*best.genome).wave();
    std::printf("generation %d: %.3f m, %.2f turns, %.2f rad/s\n", generation->number, best.score(), wave.turns,
                wave.frequency);
  }
  return evolution.living().front().score() > 0 ? 0 : 1;
}
