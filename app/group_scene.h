// A group of simulated robots as a scene to draw.
#pragma once

#include <Eigen/Core>

#include <span>
#include <string>
#include <vector>

#include "app/appearance.h"
#include "app/group_layout.h"
#include "app/scene_details.h"
#include "app/view_settings.h"
#include "render/renderer.h"
#include "sim/simulation.h"

namespace mercury {

// Keeps what Scene's spans refer to. Knows no OpenGL.
class GroupScene {
 public:
  // `offsets`: one a robot, added to its coordinates.
  GroupScene(const Simulation& simulation, std::vector<Eigen::Vector3f> offsets, const ViewSettings& settings);

  // Gives the robots to a renderer; once, and again when the robots change.
  void set_bodies(render::Renderer& renderer) const;

  // Brings everything but the positions to a moment of the simulation.
  void update(double time, std::span<const Telemetry> telemetry, SceneDetails details);

  render::Scene& scene() { return scene_; }

  // The box around each robot in the picture at the last update(), told from its centre of mass and size at rest.
  // Those of exploded robots are empty, unless all have exploded.
  std::span<const render::Bounds> bounds() const { return bounds_; }

 private:
  struct Table {
    std::size_t first_look;
    std::vector<Material> materials;
  };
  void add(const Robot& robot, const Eigen::Vector3f& offset);
  void place(std::span<const Telemetry> telemetry);
  void lengthen_paths(std::span<const Telemetry> telemetry);
  void write_labels(std::span<const Telemetry> telemetry);
  void color(SceneDetails details);

  ViewSettings settings_;
  GrowingScale scale_;
  std::vector<std::string> names_;
  std::vector<BodyShape> shapes_;
  std::vector<Table> tables_;
  std::vector<render::Look> looks_;
  std::vector<render::Placement> placements_;
  std::vector<render::Bounds> rest_;  // about the centre of mass at rest
  std::vector<render::Bounds> bounds_;
  std::vector<Eigen::Vector3f> start_;      // centres of mass when the scene was made
  std::vector<std::vector<float>> path_points_;
  std::vector<render::Path> paths_;
  std::vector<render::Label> labels_;
  std::vector<std::pair<render::Color, std::string>> swatches_;
  SceneDetails details_;
  render::Scene scene_;
};

}  // namespace mercury
