// SPDX-License-Identifier: Apache-2.0
// Defaults, names and rules of a configuration.
#include "mercury/configuration.h"

#include <gtest/gtest.h>

#include <limits>

#include "mercury/backend.h"
#include "mercury/threads.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

std::string message_of(const Configuration& configuration) {
  return refusal([&] { validate(configuration); });
}

TEST(Configuration, DefaultsAreThoseOfTheDesign) {
  const Configuration configuration;
  EXPECT_EQ(configuration.dt, 1e-3);
  EXPECT_EQ(configuration.damping, 0.1);
  EXPECT_EQ(configuration.solver, Solver::force);
  EXPECT_EQ(configuration.environment, Environment(Ocean{}));
  EXPECT_EQ(configuration.device, (Device{DeviceKind::automatic, 0, 0}));

  const Ocean ocean;
  EXPECT_EQ(ocean.density, 1000);
  EXPECT_EQ(ocean.drag_coefficient, 1);
  EXPECT_EQ(ocean.lift_coefficient, 0.2f);
  EXPECT_EQ(ocean.flow, Vec3{});
  EXPECT_EQ(ocean.gravity, Vec3{});
  EXPECT_EQ(ocean.stiffness_scale, 1);

  const OceanSimple simple;
  EXPECT_EQ(simple.point_drag, 1);
  EXPECT_EQ(simple.flow, Vec3{});
  EXPECT_EQ(simple.gravity, Vec3{});
  EXPECT_EQ(simple.stiffness_scale, 1);

  const Land land;
  EXPECT_EQ(land.gravity, (Vec3{0, 0, -9.81f}));
  EXPECT_EQ(land.friction, 0.8f);
  EXPECT_TRUE(land.self_collision);
  EXPECT_EQ(land.contact_stiffness, 100);
  EXPECT_EQ(land.stiffness_scale, 200);
}

TEST(Configuration, NamesAndParsingAreInverse) {
  for (const Solver solver : {Solver::force, Solver::xpbd}) EXPECT_EQ(solver_named(name_of(solver)), solver);
  EXPECT_EQ(name_of(Solver::xpbd), "xpbd");
  for (const Environment& environment : {Environment(Ocean{}), Environment(OceanSimple{}), Environment(Land{})})
    EXPECT_EQ(environment_named(name_of(environment)), environment);
  EXPECT_EQ(name_of(Environment(OceanSimple{})), "ocean-simple");
  for (const char* name : {"space", "space+ground", "space+contacts", "ocean+ground", "ocean+contacts",
                           "ocean+ground+contacts", "ocean-simple+ground", "ocean-simple+ground+contacts"})
    EXPECT_EQ(name_of(environment_named(name)), name);
  EXPECT_EQ(environment_named("ocean+contacts+ground"), environment_named("ocean+ground+contacts"));
  EXPECT_EQ(environment_named("land+ground"), Environment(Land{}));
  EXPECT_EQ(name_of(environment_named("space+ground+contacts")), "land");
  for (const char* name : {"", "+", "ocean+", "+ground", "ocean++ground", "ocean+lava", "ocean+land", "ground"})
    EXPECT_FALSE(is_environment(name)) << name;
  EXPECT_EQ(device_named("auto").kind, DeviceKind::automatic);
  EXPECT_EQ(device_named("cpu").kind, DeviceKind::cpu);
  EXPECT_EQ(device_named("cuda"), (Device{DeviceKind::cuda, 0, 0}));
  EXPECT_EQ(device_named("cuda:3"), (Device{DeviceKind::cuda, 3, 0}));
  EXPECT_EQ(device_named("cuda:all"), (Device{DeviceKind::cuda, Device::all_devices, 0}));
  for (const char* name : {"auto", "cpu", "cuda", "cuda:1", "cuda:all"}) EXPECT_EQ(name_of(device_named(name)), name);
}

TEST(Configuration, ErrorsForUnknownNamesListTheAcceptedOnes) {
  EXPECT_EQ(refusal([] { solver_named("euler"); }), "solver: \"euler\" is not a solver; give force or xpbd");
  EXPECT_EQ(refusal([] { environment_named("lava"); }),
            "environment: \"lava\" is not an environment; give ocean, ocean-simple, land or water");
  EXPECT_EQ(
      refusal([] { environment_named("ocean+lava"); }),
      "environment: \"ocean+lava\" is not an environment; give ocean, ocean-simple, land, water or space, followed by "
      "+ground or +contacts or both");
  EXPECT_EQ(refusal([] { device_named("gpu"); }),
            "device: \"gpu\" is not a device; give auto, cpu, cuda, cuda:N or cuda:all; did you mean cuda?");
  for (const char* name : {"gpus", "cuda:", "cuda:x", "cuda:-1", "cuda:1x", ""})
    EXPECT_EQ(refusal([&] { device_named(name); }),
              "device: \"" + std::string(name) + "\" is not a device; give auto, cpu, cuda, cuda:N or cuda:all");
}

TEST(Configuration, TimeStepAndDampingAreChecked) {
  EXPECT_EQ(message_of(Configuration{}), "");
  EXPECT_EQ(message_of(Configuration{.dt = 0}), "dt: 0 is not accepted; give a finite number > 0 s");
  EXPECT_EQ(message_of(Configuration{.dt = -0.5}), "dt: -0.5 is not accepted; give a finite number > 0 s");
  EXPECT_EQ(message_of(Configuration{.dt = std::nan("")}), "dt: nan is not accepted; give a finite number > 0 s");
  EXPECT_EQ(message_of(Configuration{.damping = -1}), "damping: -1 is not accepted; give a finite number >= 0 1/s");
  EXPECT_EQ(message_of(Configuration{.damping = 0}), "");
  EXPECT_EQ(message_of(Configuration{.device = {.threads = -2}}), "threads: -2 is not accepted; give 0 or more");
}

TEST(Configuration, EveryParameterOfEveryEnvironmentIsChecked) {
  const float nan_value = std::nanf("");
  const float infinity = std::numeric_limits<float>::infinity();
  const auto in = [](const Environment& environment) { return message_of(Configuration{.environment = environment}); };
  EXPECT_EQ(in(Ocean{.density = -1}), "density: -1 is not accepted; give a finite number >= 0 kg/m3");
  EXPECT_EQ(in(Ocean{.density = infinity}), "density: inf is not accepted; give a finite number >= 0 kg/m3");
  EXPECT_EQ(in(Ocean{.drag_coefficient = -0.5f}), "drag_coefficient: -0.5 is not accepted; give a finite number >= 0");
  EXPECT_EQ(in(Ocean{.lift_coefficient = nan_value}),
            "lift_coefficient: nan is not accepted; give a finite number >= 0");
  EXPECT_EQ(in(Ocean{.drag_tangential = -1}), "drag_tangential: -1 is not accepted; give a finite number >= 0");
  EXPECT_EQ(in(Ocean{.flow = {0, nan_value, 1}}), "flow: 0,nan,1 is not accepted; give three finite numbers of m/s");
  EXPECT_EQ(in(Ocean{.gravity = {infinity, 0, 0}}),
            "gravity: inf,0,0 is not accepted; give three finite numbers of m/s2");
  EXPECT_EQ(in(Ocean{.stiffness_scale = -2}), "stiffness_scale: -2 is not accepted; give a finite number >= 0");
  EXPECT_EQ(in(OceanSimple{.point_drag = -1}), "point_drag: -1 is not accepted; give a finite number >= 0 N s/m");
  EXPECT_EQ(in(OceanSimple{.flow = {0, 0, infinity}}),
            "flow: 0,0,inf is not accepted; give three finite numbers of m/s");
  EXPECT_EQ(in(Land{.friction = -1}), "friction: -1 is not accepted; give a finite number >= 0");
  EXPECT_EQ(in(Land{.contact_stiffness = -1}), "contact_stiffness: -1 is not accepted; give a finite number >= 0 N/m");
  EXPECT_EQ(in(Land{.stiffness_scale = nan_value}), "stiffness_scale: nan is not accepted; give a finite number >= 0");
  EXPECT_EQ(in(Ocean{.density = 0, .drag_coefficient = 0, .lift_coefficient = 5}), "");
  EXPECT_EQ(in(Land{.friction = 0, .contact_stiffness = 0, .stiffness_scale = 0}), "");
}

TEST(Configuration, GravityAndStiffnessScaleAreThoseOfTheEnvironment) {
  EXPECT_EQ(gravity_of(Land{}), (Vec3{0, 0, -9.81f}));
  EXPECT_EQ(gravity_of(Ocean{.gravity = {1, 2, 3}}), (Vec3{1, 2, 3}));
  EXPECT_EQ(gravity_of(OceanSimple{}), Vec3{});
  EXPECT_EQ(stiffness_scale_of(Land{}), 200);
  EXPECT_EQ(stiffness_scale_of(Ocean{}), 1);
  EXPECT_EQ(stiffness_scale_of(OceanSimple{.stiffness_scale = 3}), 3);
}

TEST(Configuration, NumbersOfThreadsAreLimitedByTheMachine) {
  EXPECT_GE(max_threads(), 256);
  for (const int threads : {0, 1, 256, max_threads()})
    EXPECT_EQ(refusal([&] { require_possible_threads({.threads = threads}); }), "") << threads;
  const std::string accepted = " is not accepted; give 0 (all cores) to " + std::to_string(max_threads());
  for (const int threads : {max_threads() + 1, std::numeric_limits<int>::max(), -1})
    EXPECT_EQ(refusal([&] { require_possible_threads({.threads = threads}); }),
              "threads: " + std::to_string(threads) + accepted);
  EXPECT_EQ(refusal([] { make_backend({.kind = DeviceKind::cpu, .threads = std::numeric_limits<int>::max()}); }),
            "threads: 2147483647" + accepted);
  EXPECT_EQ(message_of(Configuration{.device = {.threads = 1 << 20}}), "");  // of a file from a larger machine
}

TEST(Accepts, SaysWhatItTakes) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(Accepts::between(0, 1)(1) && !Accepts::between(0, 1)(1.5) && !Accepts::share_below_one()(1));
  EXPECT_TRUE(Accepts::at_least_zero(0) && !Accepts::above_zero(0) && !Accepts::at_least_zero(infinity));
  const Accepts limit{.lowest = 0, .above_lowest = true, .or_infinite = true};
  EXPECT_TRUE(limit(infinity) && !limit(0) && !limit(std::nan("")));
  EXPECT_EQ(Accepts::between(1, 1e6).text(true), "1 to 1000000");
  EXPECT_EQ(Accepts::at_least(1).text(true), "1 or more");
  EXPECT_EQ(Accepts::share_below_one().text(false), "at least 0 and below 1");
  EXPECT_EQ(limit.text(false), "a number > 0");
}

}  // namespace
}  // namespace mercury
