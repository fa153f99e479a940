// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_picture.h"

#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "app/live/slow_motion.h"
#include "app/scene/cameraman.h"

namespace mercury {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(float), "positions are handed on as plain floats");

bool same_layout(const ViewSettings& a, const ViewSettings& b) {
  const auto grid = [](const ViewSettings& s) {
    return s.grid ? std::pair{s.grid->columns, s.grid->rows} : std::pair{0, 0};
  };
  return a.layout == b.layout && grid(a) == grid(b) &&
         (a.camera.mode == CameraMode::top) == (b.camera.mode == CameraMode::top);
}

// The settings as the moment's details go with them.
ViewSettings fitting(const ViewSettings& settings, const Moment& moment) {
  ViewSettings fitted = settings;
  fitted.color = moment.color;
  if (moment.color != settings.color) fitted.scale.reset();
  fitted.speed = std::isfinite(moment.speed) ? moment.speed : 1;
  return fitted;
}

Group group_of(const Moment& moment) {
  Group group{.telemetry = moment.telemetry,
              .environment = moment.configuration.environment,
              .shapes = moment.robots->shapes,
              .bodies = moment.robots->bodies};
  for (const LiveRobot& robot : moment.robots->robots) {
    group.robots.push_back(robot.robot.get());
    group.materials.push_back(materials_of(robot));
    group.names.push_back(robot.name);
  }
  return group;
}

std::vector<Eigen::Vector3f> offsets_of(const Moment& moment, const ViewSettings& settings, float aspect) {
  std::vector<render::Bounds> bounds;
  for (std::size_t i = 0; i < moment.robots->size(); ++i)
    bounds.push_back(i < moment.robots->shapes.size() ? moment.robots->shapes[i]->box
                                                      : rest_bounds(*moment.robots->robots[i].robot));
  const bool land = std::holds_alternative<Land>(moment.configuration.environment);
  LayoutOptions options{.layout = settings.layout,
                        .grid = settings.grid,
                        .aspect = aspect,
                        .view = direction_of(settings.camera, land),
                        .on_ground = land || settings.camera.mode == CameraMode::top};
  // A grid that has become too small gives way.
  if (options.grid &&
      static_cast<std::size_t>(options.grid->columns) * static_cast<std::size_t>(options.grid->rows) < bounds.size())
    options.grid.reset();
  return bounds.empty() ? std::vector<Eigen::Vector3f>{} : grid_layout(bounds, options);
}

}  // namespace

struct LivePicture::Parts {
  std::shared_ptr<const Moment> moment;
  ViewSettings settings;  // as given
  std::optional<GroupScene> scene;
  std::vector<Eigen::Vector3f> offsets;
  std::uint64_t revision = 0;
  SlowMotion slow_motion;
  SlowMotion::Shown shown;

  void keep_trails(const GroupScene& old, const Moment& before) {
    for (std::size_t i = 0; i < moment->robots->size(); ++i)
      if (const auto index = before.robots->index_of(moment->robots->robots[i].id))
        scene->set_trail(i, old.trails()[*index]);
  }
};

LivePicture::LivePicture() : parts_(std::make_unique<Parts>()) {}
LivePicture::~LivePicture() = default;

void LivePicture::update(std::shared_ptr<const Moment> moment, const ViewSettings& settings, float aspect,
                         const std::set<RobotId>& selected, const std::set<RobotId>& hidden, double wall) {
  Parts& parts = *parts_;
  const std::shared_ptr<const Moment> before = std::exchange(parts.moment, moment);
  const ViewSettings old_settings = std::exchange(parts.settings, settings);
  const bool others = !before || before->robots->revision != moment->robots->revision;
  const bool moved = before && before->configuration.environment.index() != moment->configuration.environment.index();
  if (others) {
    parts.offsets = offsets_of(*moment, settings, aspect);
    const std::optional<GroupScene> old = std::exchange(parts.scene, std::nullopt);
    parts.scene.emplace(group_of(*moment), parts.offsets, fitting(settings, *moment));
    if (old && before->resets == moment->resets) parts.keep_trails(*old, *before);
    ++parts.revision;
  } else {
    if (moved || !same_layout(old_settings, settings)) lay_out(aspect);
    parts.scene->set_settings(fitting(settings, *moment));
    if (before->configuration.environment != moment->configuration.environment)
      parts.scene->set_environment(moment->configuration.environment);
    if (before->resets != moment->resets) parts.scene->restart(moment->telemetry);
    for (std::size_t i = 0; i < moment->robots->size() && before->robots != moment->robots; ++i) {
      const LiveRobot &now = moment->robots->robots[i], &then = before->robots->robots[i];
      if (now.materials != then.materials) parts.scene->set_materials(i, materials_of(now));
      if (now.name != then.name) parts.scene->set_name(i, now.name);
    }
  }
  for (std::size_t i = 0; i < moment->robots->size(); ++i) {
    const RobotId id = moment->robots->robots[i].id;
    parts.scene->mark(i, selected.contains(id), hidden.contains(id));
  }
  if (before != moment) parts.slow_motion.take(moment);
  parts.shown = parts.slow_motion.at(wall);
  parts.scene->update(parts.shown.time, parts.shown.telemetry, moment->details);
  const auto positions = parts.shown.positions;
  parts.scene->scene().positions = {positions.empty() ? nullptr : &positions.data()->x, 3 * positions.size()};
}

void LivePicture::lay_out(float aspect) {
  Parts& parts = *parts_;
  if (!parts.moment || !parts.scene) return;
  parts.offsets = offsets_of(*parts.moment, parts.settings, aspect);
  parts.scene->set_offsets(parts.offsets);
}

std::uint64_t LivePicture::bodies_revision() const { return parts_->revision; }
void LivePicture::set_bodies(render::Renderer& renderer) const { parts_->scene->set_bodies(renderer); }
render::Scene& LivePicture::scene() { return parts_->scene->scene(); }
std::span<const render::Bounds> LivePicture::bounds() const {
  return parts_->scene ? parts_->scene->bounds() : std::span<const render::Bounds>{};
}
std::span<const Vec3> LivePicture::positions_of(std::size_t robot) const {
  const std::vector<std::size_t>& offsets = parts_->moment->robots->mass_offsets;
  return parts_->shown.positions.subspan(offsets[robot], offsets[robot + 1] - offsets[robot]);
}
std::span<const Eigen::Vector3f> LivePicture::offsets() const { return parts_->offsets; }

}  // namespace mercury
