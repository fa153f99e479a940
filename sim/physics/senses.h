// SPDX-License-Identifier: Apache-2.0
// What sensors give (mercury/brain.h), from what has been measured of a body.
#pragma once

#include <cmath>
#include <cstdint>

#include "mercury/brain.h"
#include "mercury/clock.h"
#include "mercury/environment.h"
#include "sim/physics/body_frame.h"
#include "sim/physics/brain_plan.h"
#include "sim/physics/muscle.h"

namespace mercury {

// Of a part of a body: mass-weighted means, and means over springs.
struct PlaceMeasures {
  Double3 center, velocity;            // [m], [m/s]
  double strain = 0, strain_rate = 0;  // of springs, see below
  double touch = 0;                    // the share of masses on the ground
};

// Of a spring: (|d| - L0) / L0, and its rate d . (v_b - v_a) / (|d| L0) [1/s]. d = from end a to end b.
MERCURY_HOST_DEVICE double strain_of(Double3 d, double rest_length) {
  return (std::sqrt(dot(d, d)) - rest_length) / rest_length;
}
MERCURY_HOST_DEVICE double strain_rate_of(Double3 d, Double3 v, double rest_length) {
  const double length = std::sqrt(dot(d, d));
  return length > 0 ? dot(d, v) / (length * rest_length) : 0;
}

// Of the body, beside its places.
struct BodyMeasures {
  Rotation frame;
  Double3 turn_rate;  // [rad/s], in the world
};

// What senses need of the environment.
struct SensedWorld {
  Vec3 flow, light, target;
  bool ground;

  static SensedWorld of(const Environment& environment) {
    return {flow_of(environment), environment.light, environment.target, has_ground(environment)};
  }
};

// The step puts masses below the ground back to exactly 0.
MERCURY_HOST_DEVICE bool on_ground(float z) { return z <= 0; }

// Sine or cosine of a clock.
MERCURY_HOST_DEVICE float clock_sense(const BrainPlan::Sense& sense, const Clock& clock) {
  Material wave{};
  wave.frequency = sense.frequency;
  wave.phase = sense.phase;
  const std::uint64_t now = phase_at(muscle_phase(wave, clock), clock.step - clock.base_step);
  return sense.component == 0 ? sine_of_phase(now) : cosine_of_phase(now);
}

// Of a sense that depends on the body, without gain and noise.
MERCURY_HOST_DEVICE double body_sense(const BrainPlan::Sense& sense, const PlaceMeasures& place,
                                      const BodyMeasures& body, const SensedWorld& world, Vec3 target) {
  Double3 v;  // in the world, whose component in the body's frame is sensed
  switch (sense.kind) {
    case SensorKind::strain:
      return place.strain;
    case SensorKind::strain_rate:
      return place.strain_rate;
    case SensorKind::touch:
      return place.touch;
    case SensorKind::velocity:
      v = place.velocity;
      break;
    case SensorKind::turn_rate:
      v = body.turn_rate;
      break;
    case SensorKind::up:
      v = {0, 0, 1};
      break;
    case SensorKind::depth:
      return -place.center.z;
    case SensorKind::height:
      return place.center.z;
    case SensorKind::target_direction: {
      const Double3 d = Double3(target) - place.center;
      const double distance = std::sqrt(dot(d, d));
      if (!(distance > 0)) return 0;
      v = (1 / distance) * d;
      break;
    }
    case SensorKind::target_distance: {
      const Double3 d = Double3(target) - place.center;
      return std::sqrt(dot(d, d));
    }
    case SensorKind::light: {
      const Double3 d = Double3(world.light) - place.center;
      return 1 / (1 + dot(d, d));
    }
    case SensorKind::flow:
      v = Double3(world.flow) - place.velocity;
      break;
    default:
      return 0;  // the others do not depend on the body
  }
  return body.frame.to_body(v, sense.component);
}

// What a place has to be measured for.
constexpr std::uint8_t measures_of(SensorKind kind) {
  switch (kind) {
    case SensorKind::strain:
      return measure_strain;
    case SensorKind::strain_rate:
      return measure_strain_rate;
    case SensorKind::touch:
      return measure_touch;
    case SensorKind::velocity:
    case SensorKind::flow:
      return measure_velocity;
    case SensorKind::depth:
    case SensorKind::height:
    case SensorKind::target_direction:
    case SensorKind::target_distance:
    case SensorKind::light:
      return measure_center;
    default:
      return 0;
  }
}
constexpr bool needs_frame(SensorKind kind) {
  return kind == SensorKind::velocity || kind == SensorKind::turn_rate || kind == SensorKind::up ||
         kind == SensorKind::target_direction || kind == SensorKind::flow;
}

}  // namespace mercury
