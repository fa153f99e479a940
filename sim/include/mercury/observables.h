// SPDX-License-Identifier: Apache-2.0
// Quantities that can be observed of a robot: lengths, forces, energies and power, each by one formula. Telemetry of
// both backends, pictures, the window and programs of your own call these. The solvers use the same equations in forms
// of their own (sim/physics), so values agree with theirs within rounding.
//
//                    |d|
//     a o--/\/\/\/\/\/\/\/\--o b      d = x_b - x_a
//       |<---- L ---->|               L = L0 (1 + dL0 sin(omega t + phi)), the current rest length
//       |<---- L0 ------>|            L0 = Spring::rest_length
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mercury/clock.h"
#include "mercury/configuration.h"
#include "mercury/host_device.h"
#include "mercury/material.h"
#include "mercury/robot.h"
#include "mercury/vec3.h"

namespace mercury {

// What a material is at an instant, in an environment.
struct MaterialNow {
  float stiffness = 0;      // k times the environment's stiffness scale [N/m]
  float length_factor = 1;  // L / L0 [1]
  float length_rate = 0;    // d(L / L0) / dt [1/s]
};
// The phase is exact on runs of any length (sim/physics/muscle.h).
MaterialNow material_at(const Material& material, const Environment& environment, const Clock& clock);
// By id, one per material of the table.
std::vector<MaterialNow> materials_at(std::span<const Material> table, const Environment& environment,
                                      const Clock& clock);
// The same at a time in s since the start.
std::vector<MaterialNow> materials_at(std::span<const Material> table, const Environment& environment, double time);

// How far a muscle is contracted, (L0 - L) / L0 = -dL0 sin(omega t + phi) [1]. `time` as above.
float contraction(const Material& material, double time);

// |d| [m]
inline float spring_length(const Spring& spring, std::span<const Vec3> positions) {
  return length(positions[spring.b] - positions[spring.a]);
}

// (|d| - L0) / L0 [1]
MERCURY_HOST_DEVICE float strain(float length, float rest_length) {
  return (length - rest_length) * inverse(rest_length);
}

// A spring counts as strained if it is stretched or pressed together by more than this [1].
inline constexpr float strained_limit = 0.5f;
MERCURY_HOST_DEVICE bool is_strained(float strain) { return absolute(strain) > strained_limit; }

// The share of springs that are strained [1]; 0 for a robot without springs.
MERCURY_HOST_DEVICE float strained_share(std::uint32_t strained, std::uint32_t springs) {
  return springs > 0 ? static_cast<float>(strained) / static_cast<float>(springs) : 0.0f;
}

// |d| - L, with L = L0 length_factor [m]
MERCURY_HOST_DEVICE float stretch(float length, float rest_length, float length_factor) {
  return fnma(rest_length, length_factor, length);
}
inline float stretch(const Spring& spring, const MaterialNow& material, std::span<const Vec3> positions) {
  return stretch(spring_length(spring, positions), spring.rest_length, material.length_factor);
}

// k (|d| - L) (Hooke's law). Positive: the spring pulls its ends together [N]. Real is float or double.
template <class Real>
MERCURY_HOST_DEVICE Real spring_force(Real stiffness, Real stretch) {
  return stiffness * stretch;
}

// k (|d| - L)^2 / 2 [J]
template <class Real>
MERCURY_HOST_DEVICE Real elastic_energy(Real stiffness, Real stretch) {
  return Real(0.5) * spring_force(stiffness, stretch) * stretch;
}

// Power that the muscle of a spring delivers [W]. The energy of a spring changes because its ends move and because its
// muscle changes L:
//     E     = k (|d| - L)^2 / 2
//     dE/dt = k (|d| - L) d|d|/dt - k (|d| - L) dL/dt
// The first term is minus the power of the spring's force on the two masses. The second term comes from the muscle:
//     P     = -k (|d| - L) dL/dt = -k (|d| - L) L0 d(L / L0)/dt
// So over all springs, P = d/dt (kinetic + elastic energy) + the power that damping, drag and the floor take.
// Positive: the muscle does work on the body. Negative: the body does work on the muscle. 0 for passive materials.
template <class Real>
MERCURY_HOST_DEVICE Real muscle_power(Real stiffness, Real stretch, Real rest_length, Real length_rate) {
  return -spring_force(stiffness, stretch) * rest_length * length_rate;
}
inline float muscle_power(const Spring& spring, const MaterialNow& material, float stretch) {
  return muscle_power(material.stiffness, stretch, spring.rest_length, material.length_rate);
}

// The mean of a value per mass, weighted with the masses, in double precision: of positions the center of mass [m].
std::array<double, 3> mean_over_masses(const Robot& robot, std::span<const Vec3> values);

// The elastic forces of all springs on each mass [N], one per mass. `materials` by id.
std::vector<Vec3> spring_forces(const Robot& robot, std::span<const MaterialNow> materials,
                                std::span<const Vec3> positions);

// The force of the environment on a mass itself [N], apart from that on faces: its weight, and the drag of water that
// acts on each mass. `weight` without the water that it displaces [kg].
Vec3 mass_force(const Environment& environment, float weight, Vec3 velocity);

// The force of the water on a face, in two parts that add up to it.
struct FaceForce {
  Vec3 center;     // of the face [m]
  float area = 0;  // [m2]
  Vec3 drag;       // parallel to the flow past the face [N]
  Vec3 lift;       // perpendicular to it [N]
};
// Equation 1 of the paper or resistive drag as the solvers compute them (sim/physics/environments.h), with positions
// and velocities of the robot's masses. Drag and lift are 0 in an environment that does not act on faces.
// `behind` = the face's element of masses_behind_faces(); without it, the face has water on both sides.
FaceForce face_force(const Environment& environment, const Face& face, std::span<const Vec3> positions,
                     std::span<const Vec3> velocities, std::optional<std::uint16_t> behind = std::nullopt);
// By face the mass that is behind it for one-sided water (sim/physics/face_backs.h); the face's corner a if there is
// none, or if the environment has no such water.
std::vector<std::uint16_t> masses_behind_faces(const Robot& robot, const Environment& environment);

// The floor's force on one mass.
struct FloorForce {
  std::uint32_t mass = 0;  // index in Robot::masses
  Vec3 force;              // [N]
};
// The force that holds each mass on the floor in the next step, if nothing touches it except springs, gravity and the
// floor: it cancels their forces and the mass's momentum, but does not pull the mass down, and friction is at most the
// friction coefficient times the push. Only masses with such a force are listed. Empty in an environment without a
// floor.
std::vector<FloorForce> floor_forces(const Robot& robot, const Configuration& configuration,
                                     std::span<const MaterialNow> materials, std::span<const Vec3> positions,
                                     std::span<const Vec3> velocities);

}  // namespace mercury
