// SPDX-License-Identifier: Apache-2.0
// What robots live in. An environment is composed of parts:
//
//   water      none, drag on faces (as in the paper, or resistive), or drag on masses
//   ground     none, or a plane
//   contacts   none, or masses of one robot that repel each other
//   gravity, a factor for every stiffness, a target and a light for robots that sense them, a push
//
// A part is a struct with a name and a table of its parameters (parameters.h); its equations are in
// sim/physics/environments.h. Ocean, OceanSimple, Land and Water are presets: names for often used combinations.
//
//   Configuration{.environment = Ocean{.density = 900}}
//   Configuration{.environment = Environment{.water = FaceDrag{}, .ground = Plane{}, .gravity = {0, 0, -1}}}
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "mercury/parameters.h"
#include "mercury/vec3.h"

namespace mercury {

struct NoWater {
  static constexpr std::string_view name = "space";
  friend bool operator==(const NoWater&, const NoWater&) = default;
  static constexpr std::tuple<> parameters{};
};

// Water whose drag and lift act on the faces (paper, equation 1).
struct FaceDrag {
  static constexpr std::string_view name = "ocean";
  float density = 1000;           // rho [kg/m3]
  float drag_coefficient = 1;     // C_D [1]
  float lift_coefficient = 0.2f;  // C_L [1]
  float drag_tangential = 0;      // C_T [1]
  Vec3 flow;                      // velocity of the water [m/s]
  friend bool operator==(const FaceDrag&, const FaceDrag&) = default;

  static constexpr std::tuple parameters{
      Parameter("density", &FaceDrag::density, "kg/m3", Accepts::at_least_zero, {0, 2000}, "Density of the water, rho"),
      Parameter("drag_coefficient", &FaceDrag::drag_coefficient, "", Accepts::at_least_zero, {0, 3},
                "Drag coefficient of a face across the flow, C_D"),
      Parameter("lift_coefficient", &FaceDrag::lift_coefficient, "", Accepts::at_least_zero, {0, 1},
                "Lift coefficient of a face, C_L"),
      Parameter("drag_tangential", &FaceDrag::drag_tangential, "", Accepts::at_least_zero, {0, 1},
                "Tangential drag coefficient of a face along the flow, C_T"),
      Parameter("flow", &FaceDrag::flow, "m/s", Accepts::any, {-2, 2}, "Velocity of the water")};
};

// Water by resistive theory: each face feels its motion across itself and along itself apart, as the segments of a
// swimmer's body do (Gray and Hancock 1955; Taylor 1952). Water that a body displaces weighs less on it (buoyancy) and
// moves along with it (added mass).
//
// If it is one-sided, as evosoro's, it pushes only faces that move away from the body behind them, and meets them with
// the velocity halfway to the mass behind. So a rigid body feels half as much, and one that swells in place nothing.
struct ResistiveDrag {
  static constexpr std::string_view name = "resistive";
  float density = 1000;                  // rho [kg/m3]
  float normal_coefficient = 1;          // C_N [1]
  float tangential_coefficient = 0.02f;  // C_T [1]
  float added_mass_coefficient = 0.5f;   // C_A [1]
  Vec3 flow;                             // velocity of the water [m/s]
  bool one_sided = false;
  friend bool operator==(const ResistiveDrag&, const ResistiveDrag&) = default;

  static constexpr std::tuple parameters{
      Parameter("density", &ResistiveDrag::density, "kg/m3", Accepts::at_least_zero, {0, 2000},
                "Density of the water, rho"),
      Parameter("normal_coefficient", &ResistiveDrag::normal_coefficient, "", Accepts::at_least_zero, {0, 3},
                "Drag coefficient of a face that moves across itself, C_N"),
      Parameter("tangential_coefficient", &ResistiveDrag::tangential_coefficient, "", Accepts::at_least_zero, {0, 1},
                "Drag coefficient of a face that moves along itself, C_T"),
      Parameter("added_mass_coefficient", &ResistiveDrag::added_mass_coefficient, "", Accepts::at_least_zero, {0, 2},
                "Share of the displaced water that moves along with the body, C_A"),
      Parameter("flow", &ResistiveDrag::flow, "m/s", Accepts::any, {-2, 2}, "Velocity of the water"),
      Parameter("one_sided", &ResistiveDrag::one_sided,
                "Water pushes only faces that move outward, by the velocity halfway to the mass behind them")};
};

// Water that drags each mass on its own (paper, II.E).
struct PointDrag {
  static constexpr std::string_view name = "ocean-simple";
  float point_drag = 1;  // [N s/m]
  Vec3 flow;             // [m/s]
  friend bool operator==(const PointDrag&, const PointDrag&) = default;

  static constexpr std::tuple parameters{
      Parameter("point_drag", &PointDrag::point_drag, "N s/m", Accepts::at_least_zero, {0, 10},
                "Drag of a mass, force over speed through the water"),
      Parameter("flow", &PointDrag::flow, "m/s", Accepts::any, {-2, 2}, "Velocity of the water")};
};

struct NoGround {
  static constexpr std::string_view name = "";
  friend bool operator==(const NoGround&, const NoGround&) = default;
  static constexpr std::tuple<> parameters{};
};

// Solid ground at z = 0.
struct Plane {
  static constexpr std::string_view name = "ground";
  float friction = 0.8f;      // Coulomb coefficient [1]
  float static_friction = 0;  // of masses at rest [1]; counts where it is above `friction`
  friend bool operator==(const Plane&, const Plane&) = default;

  static constexpr std::tuple parameters{
      Parameter("friction", &Plane::friction, "", Accepts::at_least_zero, {0, 2}, "Coulomb friction of the floor, mu"),
      Parameter("static_friction", &Plane::static_friction, "", Accepts::at_least_zero, {0, 2},
                "Friction of the floor for masses at rest, where it is above that of motion")};
};

// Masses of one robot that no spring joins repel each other.
struct Contacts {
  static constexpr std::string_view name = "contacts";
  bool self_collision = true;
  float contact_stiffness = 100;  // k_c [N/m], times the stiffness scale
  float relative_stiffness = 0;   // if above 0, k_c is this many times the robot's stiffest spring
  float contact_distance = 0.5f;  // in shortest rest lengths of the robot
  friend bool operator==(const Contacts&, const Contacts&) = default;

  static constexpr std::tuple parameters{
      Parameter("self_collision", &Contacts::self_collision,
                "Repulsion between masses of one robot that no spring joins"),
      Parameter("contact_stiffness", &Contacts::contact_stiffness, "N/m", Accepts::at_least_zero, {0, 1000},
                "Stiffness of that repulsion, k_c, times the stiffness scale")
          .only_if(&Contacts::self_collision),
      Parameter("relative_stiffness", &Contacts::relative_stiffness, "", Accepts::at_least_zero, {0, 2},
                "Stiffness of that repulsion in stiffest springs of the robot; 0 = contact_stiffness counts")
          .only_if(&Contacts::self_collision),
      Parameter("contact_distance", &Contacts::contact_distance, "", Accepts::between(0.1, 1.5), {0.1f, 1.5f},
                "Distance within which they repel, in shortest rest lengths of the robot")
          .only_if(&Contacts::self_collision)};
};

struct Environment {
  std::variant<NoWater, FaceDrag, PointDrag, ResistiveDrag> water;
  std::variant<NoGround, Plane> ground;
  std::optional<Contacts> contacts;
  Vec3 gravity;               // [m/s2]
  float stiffness_scale = 1;  // multiplies every stiffness [1]
  Vec3 target{};              // what robots with such sensors see (mercury/brain.h) [m]
  Vec3 light{0, 0, 1};        // [m]
  float reach = 0;            // distance of the center of mass at which the target is reached; 0 = half a body [m]
  Vec3 push{};                // velocity that all masses but fixed ones get at once [m/s]
  float push_at = 0;          // when [s]
  friend bool operator==(const Environment&, const Environment&) = default;

  // Those that every environment has.
  static constexpr std::tuple parameters{
      Parameter("gravity", &Environment::gravity, "m/s2", Accepts::any, {-20, 20}, "Gravity").or_downward_magnitude(),
      Parameter("stiffness_scale", &Environment::stiffness_scale, "", Accepts::at_least_zero, {0.01f, 1000, true},
                "Multiplies every stiffness"),
      Parameter("target", &Environment::target, "m", Accepts::any, {-5, 5},
                "Place of the target that robots may sense"),
      Parameter("light", &Environment::light, "m", Accepts::any, {-5, 5}, "Place of the light that robots may sense"),
      Parameter("reach", &Environment::reach, "m", Accepts::at_least_zero, {0, 2},
                "Distance of the center of mass at which the target is reached; 0 = half the body's length"),
      Parameter("push", &Environment::push, "m/s", Accepts::any, {-3, 3},
                "Velocity that a push adds to all masses at once"),
      Parameter("push_at", &Environment::push_at, "s", Accepts::at_least_zero, {0, 10}, "Time of the push")};
};

// Whether two environments have the same parts, with whatever values.
constexpr bool same_parts(const Environment& a, const Environment& b) {
  return a.water.index() == b.water.index() && a.ground.index() == b.ground.index() &&
         a.contacts.has_value() == b.contacts.has_value();
}

// Calls visit(parameter, part, other_part) for each parameter of an environment, by its parts' tables in their order.
// `part` refers to the part of `environment` that has the member, `other_part` to that of `other`, if it has the part.
template <class Environment1, class Environment2, class Visit>
constexpr void for_each_parameter_pair(Environment1& environment, Environment2& other, Visit&& visit) {
  const auto visit_table = [&]<class Part>(Part& part, auto& other_part) {
    std::apply([&](const auto&... parameter) { (visit(parameter, part, other_part), ...); },
               std::remove_const_t<Part>::parameters);
  };
  const auto visit_choice = [&](auto& choice, auto& others) {
    std::visit(
        [&]<class Part>(Part& part) {
          if (auto* const other_part = std::get_if<std::remove_const_t<Part>>(&others)) visit_table(part, *other_part);
        },
        choice);
  };
  visit_choice(environment.water, other.water);
  visit_choice(environment.ground, other.ground);
  if (environment.contacts && other.contacts) visit_table(*environment.contacts, *other.contacts);
  visit_table(environment, other);
}

// for_each_parameter (parameters.h) of all parts.
template <class Visit>
constexpr void for_each_parameter(Environment& environment, Visit&& visit) {
  for_each_parameter_pair(environment, environment,
                          [&](const auto& parameter, auto& part, auto&) { visit(parameter, part.*parameter.member); });
}
template <class Visit>
constexpr void for_each_parameter(const Environment& environment, Visit&& visit) {
  for_each_parameter_pair(environment, environment, [&](const auto& parameter, const auto& part, const auto&) {
    visit(parameter, part.*parameter.member);
  });
}

// The presets. Each converts to the environment that it names.

// Water; drag and lift act on the faces.
struct Ocean {
  static constexpr std::string_view name = "ocean", help = "drag on the skin";
  float density = FaceDrag{}.density;                    // rho [kg/m3]
  float drag_coefficient = FaceDrag{}.drag_coefficient;  // C_D [1]
  float lift_coefficient = FaceDrag{}.lift_coefficient;  // C_L [1]
  float drag_tangential = FaceDrag{}.drag_tangential;    // C_T [1]
  Vec3 flow;                                             // velocity of the water [m/s]
  Vec3 gravity;                                          // [m/s2]
  float stiffness_scale = 1;                             // multiplies every stiffness [1]

  constexpr operator Environment() const {
    return {.water = FaceDrag{density, drag_coefficient, lift_coefficient, drag_tangential, flow},
            .ground = {},
            .contacts = {},
            .gravity = gravity,
            .stiffness_scale = stiffness_scale};
  }
};

// Water; each mass is dragged on its own.
struct OceanSimple {
  static constexpr std::string_view name = "ocean-simple", help = "drag on each mass";
  float point_drag = PointDrag{}.point_drag;  // [N s/m]
  Vec3 flow;                                  // [m/s]
  Vec3 gravity;                               // [m/s2]
  float stiffness_scale = 1;                  // [1]

  constexpr operator Environment() const {
    return {.water = PointDrag{point_drag, flow},
            .ground = {},
            .contacts = {},
            .gravity = gravity,
            .stiffness_scale = stiffness_scale};
  }
};

// Solid ground at z = 0. Masses of one robot that no spring joins repel each other.
struct Land {
  static constexpr std::string_view name = "land", help = "floor, friction, gravity";
  Vec3 gravity{0, 0, -9.81f};         // [m/s2]
  float friction = Plane{}.friction;  // Coulomb coefficient [1]
  bool self_collision = true;
  float contact_stiffness = Contacts{}.contact_stiffness;  // k_c [N/m], times the stiffness scale
  float stiffness_scale = 200;                             // [1]

  constexpr operator Environment() const {
    return {.water = {},
            .ground = Plane{friction},
            .contacts = Contacts{self_collision, contact_stiffness},
            .gravity = gravity,
            .stiffness_scale = stiffness_scale};
  }
};

// Resistive water with contacts, for robots of real materials.
struct Water {
  static constexpr std::string_view name = "water", help = "resistive drag, added mass, contacts";
  ResistiveDrag drag;
  Vec3 gravity;  // [m/s2]
  // As stiff as the body, at 0.9 of the distance of neighbors: the middle between four masses of a lattice is 0.71 of
  // it from each, so what passes there has to push them aside.
  Contacts contacts{.relative_stiffness = 1, .contact_distance = 0.9f};

  constexpr operator Environment() const {
    return {.water = drag, .ground = {}, .contacts = contacts, .gravity = gravity, .stiffness_scale = 1};
  }
};

struct EnvironmentPreset {
  std::string_view name, help;
  Environment environment;

  template <class Preset>
  explicit constexpr EnvironmentPreset(const Preset& preset)
      : name(Preset::name), help(Preset::help), environment(preset) {}
};

// Names, options, panels and files follow from this list.
inline constexpr std::array environment_presets{EnvironmentPreset(Ocean{}), EnvironmentPreset(OceanSimple{}),
                                                EnvironmentPreset(Land{}), EnvironmentPreset(Water{})};

// "ocean", "ocean-simple", "land", "water".
std::vector<std::string_view> environment_names();
// The preset that has the same parts; for other combinations the water and the parts that are added to it, as
// "ocean+ground+contacts", or "space+ground" without water.
std::string_view name_of(const Environment& environment);
// The reverse, with defaults: of the preset or the water before the first "+", and of each part that is added. Throws
// ParameterError that lists what is accepted.
Environment environment_named(std::string_view name);
bool is_environment(std::string_view name);

inline Vec3 gravity_of(const Environment& environment) { return environment.gravity; }
inline float stiffness_scale_of(const Environment& environment) { return environment.stiffness_scale; }

inline bool has_water(const Environment& environment) { return !std::holds_alternative<NoWater>(environment.water); }
// Whether robots stand on something. They are set down on it with their lowest mass at z = 0.
inline bool has_ground(const Environment& environment) { return !std::holds_alternative<NoGround>(environment.ground); }
// Whether the environment acts on faces.
inline bool has_face_forces(const Environment& environment) {
  return std::holds_alternative<FaceDrag>(environment.water) ||
         std::holds_alternative<ResistiveDrag>(environment.water);
}
// Whether masses that no spring joins repel each other.
inline bool has_contacts(const Environment& environment) {
  return environment.contacts && environment.contacts->self_collision &&
         (environment.contacts->contact_stiffness > 0 || environment.contacts->relative_stiffness > 0);
}
// The velocity of the water [m/s]; 0 without water.
Vec3 flow_of(const Environment& environment);

}  // namespace mercury
