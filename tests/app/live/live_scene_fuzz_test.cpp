// SPDX-License-Identifier: Apache-2.0
// Random calls in random order: nothing throws, nothing hangs, and the snapshots stay consistent.
#include <gtest/gtest.h>

#include <cmath>

#include "app/live/measurements.h"
#include "app/live/scene_comparison.h"
#include "app/live/scene_files.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "mercury/random.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"

namespace mercury {
namespace {

class LiveFuzz : public test::FolderTest, public testing::WithParamInterface<std::uint64_t> {
 protected:
  Random random{GetParam()};
  LiveScene scene{test::on_cpu()};

  std::uint64_t below(std::uint64_t n) { return random.below(n); }
  float number() {
    constexpr float odd[] = {0, -1, 1e-20f, 1e20f, NAN, INFINITY, -INFINITY, 1, 0.5f};
    return below(3) == 0 ? odd[below(std::size(odd))] : static_cast<float>(random.uniform(-3, 3));
  }
  RobotId robot() {
    const auto ids = test::ids_of(scene);
    return ids.empty() || below(20) == 0 ? below(50) : ids[below(ids.size())];
  }
  std::vector<RobotId> some() { return below(8) == 0 ? test::ids_of(scene) : std::vector{robot(), robot()}; }
  std::string file() {
    constexpr const char* names[] = {"a.json", "b.json", "c.cbor", "d.cbor"};
    return path(names[below(std::size(names))]);
  }

  Configuration configuration() {
    Configuration wanted = scene.document().configuration;
    switch (below(6)) {
      case 0:
        wanted.environment = Ocean{.density = number(), .flow = {number(), 0, 0}};
        break;
      case 1:
        wanted.environment = Land{.friction = number()};
        break;
      case 2:
        wanted.environment = OceanSimple{.point_drag = number()};
        break;
      case 3:
        wanted.dt = below(2) ? 1e-3 : static_cast<double>(number());
        break;
      case 4:
        wanted.solver = below(2) ? Solver::force : Solver::xpbd;
        break;
      default:
        wanted.damping = number();
    }
    return wanted;
  }
  ViewSettings view() {
    ViewSettings wanted;
    wanted.color = &color_quantities()[below(color_quantities().size())];
    wanted.shown = {.skin = below(2) == 0,
                    .springs = below(2) == 0,
                    .path = below(2) == 0,
                    .labels = below(2) == 0,
                    .legend = below(2) == 0};
    wanted.shown.arrows = {.drag = below(2) == 0, .velocity = below(2) == 0};
    if (below(4) == 0) wanted.grid = Grid{2, 1};
    if (below(4) == 0) wanted.layout = Layout::race;
    return wanted;
  }
  render::Ray ray() {
    return {.origin = {number(), number(), 3}, .direction = render::Vector3(number(), number(), -1).normalized()};
  }

  void act() {
    constexpr const char* differences[] = {"solver=xpbd", "environment=land", "dt=0.0004", "damping=3,density=10"};
    switch (below(33)) {
      case 30:
        scene.comparison().set_second(SideDifference(differences[below(std::size(differences))]));
        break;
      case 31:
        scene.comparison().show_ghosts(some());
        break;
      case 32:
        below(2) ? scene.comparison().set_second(std::nullopt) : scene.comparison().hide_ghosts();
        break;
      case 0:
        scene.time().play();
        break;
      case 1:
        scene.time().pause();
        break;
      case 2:
        scene.time().step(static_cast<std::int64_t>(below(20)));
        break;
      case 3:
        scene.time().reset();
        break;
      case 4:
        scene.time().set_speed(number());
        break;
      case 5:
        scene.time().change_speed(static_cast<int>(below(5)) - 2);
        break;
      case 6:
        if (test::ids_of(scene).size() < 8)
          scene.robots().generate({.count = below(3), .seed = below(9)}, below(6) == 0);
        break;
      case 7:
        scene.robots().remove(some());
        break;
      case 8:
        if (test::ids_of(scene).size() < 8) scene.robots().duplicate(some());
        break;
      case 9:
        if (test::ids_of(scene).size() < 8) scene.robots().mutate(some(), {.seed = below(99)}, below(2) == 0);
        break;
      case 10:
        scene.undo();
        break;
      case 11:
        scene.redo();
        break;
      case 12:
        scene.selection().select(robot(), below(2) == 0);
        break;
      case 13:
        scene.parameters().set_configuration(configuration());
        break;
      case 14:
        scene.set_view(view());
        break;
      case 15:
        scene.parameters().scale_materials(some(), {number(), number(), number(), number()});
        break;
      case 16:
        scene.parameters().set_material(some(), static_cast<MaterialId>(below(256)),
                                        {number(), number(), number(), number()});
        break;
      case 17:
        scene.parameters().reset_materials(some());
        break;
      case 18:
        if (const auto hit = scene.mouse().pick(ray())) scene.mouse().begin_perturbation(*hit, number());
        break;
      case 19:
        scene.mouse().move_perturbation({number(), number(), number()});
        break;
      case 20:
        scene.mouse().end_perturbation();
        break;
      case 21:
        scene.selection().set_hidden(robot(), below(2) == 0);
        break;
      case 22:
        scene.files().save(robot(), file(), below(2) == 0);
        break;
      case 23:
        if (test::ids_of(scene).size() < 8) scene.files().open({file()});
        break;
      case 24:
        scene.time().pause_on_explosion(below(2) == 0);
        break;
      case 25:
        scene.parameters().set_configuration({});
        break;
      case 26:
        scene.robots().rename(robot(), below(2) ? "eel" : "");
        break;
      case 27:
        scene.mouse().begin_perturbation({.robot = robot(), .mass = static_cast<std::uint16_t>(below(70000))},
                                         number());
        break;
      case 28:
        scene.mouse().describe({.robot = robot(),
                                .mass = static_cast<std::uint16_t>(below(70000)),
                                .spring = static_cast<std::uint32_t>(below(1u << 20))});
        break;
      default:
        scene.files().save_repro(robot(), folder_ / "repro", below(2) == 0);
    }
  }

  void look() {
    scene.frame(number());
    const Snapshot& snapshot = scene.snapshot();
    ASSERT_EQ(snapshot.telemetry.size(), snapshot.robots->size());
    ASSERT_EQ(snapshot.positions.size(), snapshot.robots->mass_offsets.back());
    ASSERT_EQ(scene.drawn().offsets().size(), snapshot.robots->size());
    ASSERT_EQ(scene.drawn().scene().placements.size(), snapshot.robots->size());
    if (!snapshot.details.values.mass.empty()) {
      ASSERT_EQ(snapshot.details.values.mass.size(), snapshot.positions.size());
    }
    scene.mouse().perturbation();
    scene.measurements().ranking();
    series_csv(scene.document(), scene.measurements(), test::ids_of(scene));
    scene.files().command();
  }
};
INSTANTIATE_TEST_SUITE_P(Seeds, LiveFuzz, testing::Values(1, 2, 3));

TEST_P(LiveFuzz, RandomCallsLeaveAConsistentScene) {
  for (int i = 0; i < 1500; ++i) {
    ASSERT_NO_THROW(act()) << i;
    if (below(3) == 0) look();
    if (HasFatalFailure()) return;
  }
  scene.time().pause();
  scene.wait_until_done();
  // The snapshot shows the robots of the document.
  ASSERT_EQ(scene.snapshot().robots->size(), scene.document().robots.size());
  for (std::size_t i = 0; i < scene.document().robots.size(); ++i)
    EXPECT_EQ(scene.snapshot().robots->robots[i].id, scene.document().robots[i].body.id);
  EXPECT_EQ(scene.snapshot().configuration, scene.document().configuration);
}

}  // namespace
}  // namespace mercury
