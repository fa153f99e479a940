// SPDX-License-Identifier: Apache-2.0
// Picking: what a ray hits, compared with independent calculations.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>

#include "app/live/picking.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "mercury/random.h"
#include "tests/app/live/live_scene_setup.h"

namespace mercury {
namespace {

using Eigen::Vector3d;
using render::Vector3;

Vector3d exact(const Vector3& v) { return {v.x, v.y, v.z}; }

// Intersects a triangle by solving for barycentric coordinates and distance in double precision.
std::optional<double> crossing(const render::Ray& ray, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  Eigen::Matrix3d columns;
  columns << b - a, c - a, -exact(ray.direction);
  const Vector3d right = exact(ray.origin) - a;
  const double determinant = columns.determinant();
  if (std::abs(determinant) < 1e-12) return std::nullopt;
  Vector3d solution;
  for (int i = 0; i < 3; ++i) {  // Cramer's rule
    Eigen::Matrix3d replaced = columns;
    replaced.col(i) = right;
    solution[i] = replaced.determinant() / determinant;
  }
  if (solution[0] < 0 || solution[1] < 0 || solution[0] + solution[1] > 1 || solution[2] <= 0) return std::nullopt;
  return solution[2];
}

TEST(LivePicking, HitsTheFaceThatBruteForceFinds) {
  test::RobotScene scene(6);
  test::step_and_wait(scene, 200);
  const Snapshot& snapshot = scene.snapshot();
  Random random(1);
  int met = 0;
  for (int shot = 0; shot < 400; ++shot) {
    const std::size_t aim = random.below(snapshot.robots->size());
    const Vector3 target = Vector3(snapshot.positions_of(aim)[random.below(snapshot.positions_of(aim).size())]) +
                           scene.drawn().offsets()[aim];
    render::Ray ray{.origin = {static_cast<float>(random.uniform(-5, 5)), static_cast<float>(random.uniform(-5, 5)),
                               static_cast<float>(random.uniform(-5, 5))}};
    const Vector3 jitter(static_cast<float>(random.uniform(-0.2, 0.2)), static_cast<float>(random.uniform(-0.2, 0.2)),
                         static_cast<float>(random.uniform(-0.2, 0.2)));
    ray.direction = (target + jitter - ray.origin).normalized();
    double nearest = INFINITY, second = INFINITY;
    std::size_t robot = 0;
    std::uint32_t face = 0;
    for (std::size_t i = 0; i < snapshot.robots->size(); ++i) {
      const auto& faces = snapshot.robots->robots[i].robot->faces;
      const auto place = [&](std::uint16_t mass) -> Vector3d {
        return exact(Vector3(snapshot.positions_of(i)[mass]) + scene.drawn().offsets()[i]);
      };
      for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const auto t = crossing(ray, place(faces[f].a), place(faces[f].b), place(faces[f].c));
        if (!t) continue;
        if (*t < nearest) {
          second = nearest;
          nearest = *t;
          robot = i;
          face = f;
        } else {
          second = std::min(second, *t);
        }
      }
    }
    const auto hit = scene.mouse().pick(ray);
    if (std::isinf(nearest)) {
      EXPECT_FALSE(hit) << shot;
      continue;
    }
    ++met;
    ASSERT_TRUE(hit) << shot;
    EXPECT_NEAR(hit->distance, nearest, 1e-3);
    if (second - nearest < 1e-3) continue;  // two faces at their common edge
    EXPECT_EQ(hit->index, robot);
    EXPECT_EQ(hit->face, face);
    EXPECT_LT((hit->point - (ray.origin + static_cast<float>(nearest) * ray.direction)).norm(), 1e-3f);
  }
  EXPECT_GT(met, 150);
}

// A robot that is torn apart is not drawn, also when it is selected: it would fill the view.
TEST(LivePicking, HitsNoWreck) {
  LiveScene scene(test::on_cpu(OceanSimple{}));
  Robot bomb{.name = "bomb", .masses = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}};
  bomb.materials = {{}, {.stiffness = 50}, {.stiffness = 1e8f}};
  bomb.springs = {{0, 1, 1, 0.98f}, {1, 2, 2, 0.98f}};
  scene.robots().add({bomb});
  ViewSettings view = scene.view();
  view.shown.springs = view.shown.masses = true;
  scene.set_view(view);
  test::step_and_wait(scene, 400);
  ASSERT_TRUE(scene.snapshot().telemetry[0].exploded);
  const Vector3 mass = Vector3(scene.snapshot().positions_of(0)[0]) + scene.drawn().offsets()[0];
  ASSERT_TRUE(mass.is_finite());
  const render::Ray ray{mass + Vector3(0, 0, 5), Vector3(0, 0, -1)};
  EXPECT_FALSE(scene.mouse().pick(ray));
  scene.selection().select(scene.robots().entries().front().id);
  scene.frame(1.5f);
  EXPECT_FALSE(scene.mouse().pick(ray));
}

Robot two_springs() {
  Robot robot{.name = "pair", .masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  robot.springs = {{0, 1, 21, 0.8f}, {0, 2, 1, 1}};
  return robot;
}

TEST(LivePicking, HitsSpringsWithinTheRadiusAndReportsTheirForce) {
  LiveScene scene(test::on_cpu(OceanSimple{.stiffness_scale = 3}));
  scene.robots().add({two_springs()});
  scene.wait_until_done();
  const Vector3 offset = scene.drawn().offsets()[0];
  const auto from_above = [&](float x, float y) {
    return render::Ray{.origin = offset + Vector3(x, y, 2), .direction = {0, 0, -1}};
  };
  const auto hit = pick(scene.snapshot(), scene.drawn().offsets(), from_above(0.7f, -0.04f), {.radius = 0.05f});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->spring, 0u);
  EXPECT_EQ(hit->mass, 1);
  EXPECT_NEAR(hit->distance, 2, 1e-5f);
  EXPECT_FALSE(pick(scene.snapshot(), scene.drawn().offsets(), from_above(0.7f, -0.06f), {.radius = 0.05f}));
  const HitDetails figures = scene.mouse().describe(*hit);
  ASSERT_TRUE(figures.spring);
  EXPECT_EQ(figures.robot, "pair");
  EXPECT_EQ(figures.spring->material_name, "tissue");
  // Hooke's law: 40 N/m times the environment's factor of 3; length 1 m, rest length 0.8 m.
  EXPECT_NEAR(figures.spring->force, 3 * 40 * 0.2f, 1e-4f);
  EXPECT_NEAR(figures.spring->strain, 0.25f, 1e-6f);
  EXPECT_EQ(figures.mass.springs, 1u);
  EXPECT_EQ(figures.mass.speed, 0);
}

TEST(LivePicking, IgnoresHiddenRobotsAndPartsCutAway) {
  test::RobotScene scene(1);
  const render::Bounds box = scene.drawn().bounds()[0];
  const render::Ray ray{.origin = box.center() + Vector3(0, 0, 5), .direction = {0, 0, -1}};
  const auto hit = scene.mouse().pick(ray);
  ASSERT_TRUE(hit);
  ViewSettings view = scene.view();
  view.cut = render::Cut{.axis = 2, .percent = 50};
  scene.set_view(view);
  const auto deeper = scene.mouse().pick(ray);
  EXPECT_TRUE(!deeper || deeper->distance > hit->distance);
  view.cut->below = true;
  scene.set_view(view);
  EXPECT_EQ(scene.mouse().pick(ray)->distance, hit->distance) << "what is above the middle is still there";
  scene.selection().set_hidden(test::ids_of(scene)[0], true);
  EXPECT_FALSE(scene.mouse().pick(ray));
}

}  // namespace
}  // namespace mercury
