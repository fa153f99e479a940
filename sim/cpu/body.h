// One robot as the CPU steps it: structure of arrays, so that loops over masses and springs become vector code.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/backend.h"
#include "sim/measures.h"

namespace mercury::cpu {

struct Vectors {
  std::vector<float> x, y, z;
  void resize(std::size_t n) {
    x.resize(n);
    y.resize(n);
    z.resize(n);
  }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, Vec3 value) {
    x[i] = value.x;
    y[i] = value.y;
    z[i] = value.z;
  }
};

struct Sums {
  std::vector<std::int32_t> x, y, z;
  void assign(std::size_t n) {
    x.assign(n, 0);
    y.assign(n, 0);
    z.assign(n, 0);
  }
};

struct Springs {
  std::vector<std::uint16_t> a, b;
  std::vector<MaterialId> material;
  std::vector<float> rest_length;
  std::vector<float> splits;  // s_a + s_b
};

// Masses that a spring joins to each mass, those of mass i at [start[i], start[i + 1]).
struct Neighbours {
  std::vector<std::uint32_t> start;
  std::vector<std::uint16_t> mass;
  bool joined(std::uint16_t i, std::uint16_t j) const {
    for (std::uint32_t k = start[i]; k < start[i + 1]; ++k)
      if (mass[k] == j) return true;
    return false;
  }
};

struct ContactGrid {
  std::vector<std::uint16_t> head, next;  // buckets, masses
};

// What a material is at the present step.
struct SpringLaw {
  std::array<float, max_materials> factor{};      // L / L0
  std::array<float, max_materials> stiffness{};   // in units of force a metre
  std::array<float, max_materials> compliance{};  // 1/(k dt^2), divided by the scale of corrections
};

struct Body {
  const Robot* robot = nullptr;
  RobotMeasures measures;
  Vectors x, v;
  Sums force;
  Springs springs;
  Neighbours neighbours;
  ContactGrid grid;
  std::vector<Material> materials;  // max_materials elements
  std::vector<MusclePhase> phases;  // likewise, for the present clock base
  FixedPointScale scale;
  SpringLaw law;
  RobotStatus status;
  std::vector<Pull> pulls;
};

Body make_body(const Robot& robot);
// What depends on materials and configuration.
void update_laws(Body& body, const Configuration& configuration);
// Phases for a clock whose base or time step is new.
void update_phases(Body& body, const Clock& clock);

}  // namespace mercury::cpu
