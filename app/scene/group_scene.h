// SPDX-License-Identifier: Apache-2.0
// A group of simulated robots as a scene to draw.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/scene/appearance.h"
#include "app/scene/color_scale.h"
#include "app/scene/footprints.h"
#include "app/scene/group_motion.h"
#include "app/scene/race.h"
#include "app/scene/robot_shape.h"
#include "app/scene/scene_details.h"
#include "app/scene/trail.h"
#include "app/scene/view_settings.h"
#include "mercury/simulation.h"
#include "render/renderer.h"
#include "render/vector.h"

namespace mercury {

// The robots of a group, for making its scene. The scene does not refer to it afterward.
struct Group {
  std::vector<const Robot*> robots;
  std::vector<std::string> names;                    // one per robot
  std::vector<std::span<const Material>> materials;  // one table per robot, as the simulation has them now
  std::vector<Telemetry> telemetry;                  // one per robot
  Environment environment;
  std::vector<std::shared_ptr<const RobotShape>> shapes;  // one per robot; empty = the scene makes them
  std::shared_ptr<const render::BodyData> bodies;         // of the shapes; nullptr = the scene makes them
};
Group group_of(const Simulation& simulation);

// Owns the data of a render::Scene and updates it. Uses no OpenGL.
class GroupScene {
 public:
  // `offsets`: one per robot, added to its coordinates at the start (group_offsets()).
  GroupScene(const Group& group, std::vector<render::Vector3> offsets, const ViewSettings& settings);
  GroupScene(const Simulation& simulation, std::vector<render::Vector3> offsets, const ViewSettings& settings)
      : GroupScene(group_of(simulation), std::move(offsets), settings) {}

  // Changes that need no new bodies; they take effect at the next update().
  void set_settings(const ViewSettings& settings);
  void set_environment(const Environment& environment);
  void set_offsets(std::span<const render::Vector3> offsets);
  void set_materials(std::size_t robot, std::span<const Material> materials);
  void set_name(std::size_t robot, const std::string& name) { names_[robot] = name; }
  // What is drawn behind the robots, in plain surroundings.
  void set_background(std::vector<render::Tile> tiles, std::vector<render::Text> texts);
  void mark(std::size_t robot, bool selected, bool hidden);
  // Starts all trails again at these positions, without footprints.
  void restart(std::span<const Telemetry> telemetry);
  const std::vector<Trail>& trails() const { return trails_; }
  void set_trail(std::size_t robot, Trail trail) { trails_[robot] = std::move(trail); }
  // The same of footprints, one per robot.
  const std::vector<Footprints>& footprints() const { return footprints_; }
  void set_footprints(std::size_t robot, Footprints footprints) { footprints_[robot] = std::move(footprints); }
  // What trails and footprints do when time goes back.
  void set_later(Later later) { later_ = later; }
  // The mouse pulls at this robot; `elapsed` since the last call [s]. See HeldRobot.
  void hold(std::optional<std::size_t> robot, double elapsed) { held_.hold(robot, elapsed); }

  // The camera of a window, in which the scale counts the robots in view (ViewSettings::scale_all). Without a camera it
  // counts all.
  void see(const render::Camera& camera, float aspect) { seen_ = {camera, aspect}; }

  // Gives the robots to a renderer. Call it once, and again when the robots change.
  void set_bodies(render::Renderer& renderer) const;

  // Updates everything except the positions to a time of the simulation.
  void update(double time, std::span<const Telemetry> telemetry, SceneDetails details);

  render::Scene& scene() { return scene_; }

  // The box around each robot in the picture at the last update(), estimated from its center of mass and its size at
  // rest. Boxes of exploded robots are empty, unless all robots have exploded; then they are where the robots were
  // last.
  std::span<const render::Bounds> bounds() const { return bounds_; }
  // The same for cameras, which show more than the robots: whole cells, and lanes from the start line on.
  std::span<const render::Bounds> camera_boxes() const { return camera_boxes_; }
  // The same for each robot, at the place where it was last if it has exploded.
  std::span<const render::Bounds> last_boxes() const { return last_boxes_; }
  // What is added to each robot's own coordinates in the picture at the last update() [m].
  std::span<const render::Vector3> offsets() const { return shown_offsets_; }
  // The middle of a robot's cell, or of where it starts in other layouts [m].
  render::Vector3 cell_center(std::size_t robot) const { return offsets_[robot] + rooms_[robot].center; }
  // What is added to the coordinates of a robot's ghost, whose center of mass is there.
  render::Vector3 ghost_offset(std::size_t robot, Vec3 center_of_mass) const {
    return motion_.ghost_offset(shown_offsets_[robot], rooms_[robot], trails_[robot], center_of_mass);
  }

 private:
  // The render materials of robots with the same materials. `own` are those of the robot's file, which give the
  // colors; `materials` are those of the simulation now.
  struct Table {
    std::size_t first_material = 0;
    std::vector<Material> own, materials;
    bool defaults = true;                    // `own` is the default table
    std::size_t robots = 0;                  // that use it; 0 = free
    std::optional<std::size_t> driven = {};  // the only robot that uses it, whose muscles do not follow their sines
  };
  void add(const Robot& robot, std::span<const Material> materials, const RobotShape& shape,
           const render::Vector3& offset);
  std::size_t table_for(std::span<const Material> own, std::span<const Material> materials, bool defaults);
  std::size_t new_table(std::span<const Material> own, std::span<const Material> materials, bool defaults);
  void use_table(std::size_t robot, std::size_t table);
  void activate(double time, const DrivenMaterials& driven);
  void show_surroundings();
  void place_floor();
  void place(std::span<const Telemetry> telemetry);
  void place_boxes();
  void place_patches();
  void note_movers(std::span<const Telemetry> telemetry);
  void hide_wrecks(std::span<const Telemetry> telemetry);
  void leave_footprints(double time, std::span<const GroundContacts> contacts);
  void lengthen_paths(double time);
  void race(double time);
  void mark_senses(std::span<const TouchMark> touches);
  void write_labels(std::span<const Telemetry> telemetry);
  std::vector<bool> in_view() const;
  void fit_scale(double time);
  void color(double time, SceneDetails details);

  ViewSettings settings_;
  ColorScale scale_;
  std::optional<std::pair<render::Camera, float>> seen_;
  std::vector<std::size_t> face_counts_, spring_counts_, mass_counts_;  // one per robot
  // The robots that the scale counts, and what is shown of them, at the last update().
  std::vector<bool> counted_;
  render::Show counted_show_;
  std::vector<std::string> names_;
  std::shared_ptr<const render::BodyData> bodies_;
  std::vector<Table> tables_;
  std::vector<render::RenderMaterial> materials_;
  std::vector<render::Placement> placements_;
  std::vector<render::Bounds> rest_;  // around the center of mass, at rest
  std::vector<Room> rooms_;
  std::vector<render::Vector3> offsets_, shown_offsets_;  // at the start, and now
  GroupMotion motion_;
  float mark_distance_ = 1;  // [m]
  HeldRobot held_;
  MarkTimes mark_times_;
  Course course_;
  std::string order_;  // of passing in a race
  std::vector<render::Bounds> bounds_, last_boxes_, camera_boxes_;
  std::vector<bool> hidden_, exploded_, torn_;
  std::vector<std::size_t> table_of_;  // one per robot
  std::vector<bool> smooth_;           // robots that are drawn smooth whatever the settings
  Environment environment_;
  std::vector<Trail> trails_;
  std::vector<Footprints> footprints_;
  std::vector<std::vector<render::Print>> prints_of_robots_;
  std::vector<render::Print> prints_;  // of all
  Later later_ = Later::forget;
  std::vector<render::Path> paths_;
  std::vector<std::vector<float>> marks_;         // of the paths
  std::vector<bool> seeks_target_, seeks_light_;  // robots with a sensor of the target, of the light
  std::vector<std::vector<float>> sense_lines_;   // around these and toward them, in the robots' coordinates
  std::vector<render::Label> labels_;
  std::vector<render::Patch> patches_;
  std::vector<render::Mover> movers_;
  std::vector<render::Tile> tiles_;
  std::vector<render::Text> texts_, shown_texts_;
  render::Legend materials_legend_;
  SceneDetails details_;
  render::Scene scene_;
};

}  // namespace mercury
