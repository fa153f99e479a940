// SPDX-License-Identifier: Apache-2.0
#include "app/scene/appearance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mercury/observables.h"

namespace mercury {
namespace {

// The springs at each mass, listed at the lower of their two masses. A window builds this often, and a hash table of
// all springs takes many times as long.
class SpringsByMass {
 public:
  explicit SpringsByMass(const Robot& robot) : first_(robot.masses.size() + 1), springs_(robot.springs.size()) {
    for (const Spring& spring : robot.springs) ++first_[lower(spring) + 1u];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    std::vector<std::uint32_t> next(first_);
    for (const Spring& spring : robot.springs) springs_[next[lower(spring)]++] = &spring;
  }
  // The first spring that joins them, or nullptr.
  const Spring* between(std::uint16_t a, std::uint16_t b) const {
    if (a > b) std::swap(a, b);
    for (std::uint32_t i = first_[a]; i < first_[a + 1u]; ++i)
      if (std::max(springs_[i]->a, springs_[i]->b) == b) return springs_[i];
    return nullptr;
  }

 private:
  static std::uint16_t lower(const Spring& spring) { return std::min(spring.a, spring.b); }
  std::vector<std::uint32_t> first_;
  std::vector<const Spring*> springs_;
};

// The range of the values added so far.
struct Range {
  float low = INFINITY, high = -INFINITY;
  void add(float value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  float share_of(float value) const { return high > low ? (value - low) / (high - low) : 0.5f; }
};

render::Color color_of(const Material& material, const Range& frequencies, const Range& passive) {
  if (material.amplitude != 0) return render::muscle_color(material.phase, frequencies.share_of(material.frequency));
  // From the softest passive material, colored as tissue, to the stiffest, colored as bone.
  return render::mix(render::tissue_color, render::bone_color, passive.share_of(material.stiffness));
}

}  // namespace

BodyShape::BodyShape(const Robot& robot, std::uint32_t first_material) {
  for (const Vec3 p : robot.masses) rest_positions_.insert(rest_positions_.end(), {p.x, p.y, p.z});
  for (const Face& face : robot.faces) faces_.insert(faces_.end(), {face.a, face.b, face.c});
  for (const Spring& spring : robot.springs) {
    springs_.insert(springs_.end(), {spring.a, spring.b});
    spring_materials_.push_back(first_material + spring.material);
  }
  for (const MaterialId id : face_materials(robot)) face_materials_.push_back(first_material + id);
}

render::Body BodyShape::body() const {
  return {.rest_positions = rest_positions_,
          .faces = faces_,
          .springs = springs_,
          .face_materials = face_materials_,
          .spring_materials = spring_materials_};
}

namespace {

// The material that a material is drawn as: itself, but a passive one that has the name of an actuator is drawn as that
// actuator's muscle. So the skin of a voxel whose edges alone are muscles shows them.
std::vector<MaterialId> drawn_materials(const Robot& robot) {
  std::vector<MaterialId> drawn(max_materials);
  for (std::size_t id = 0; id < drawn.size(); ++id) drawn[id] = static_cast<MaterialId>(id);
  for (const Actuator& actuator : robot.actuators)
    for (std::size_t id = 1; id < robot.material_names.size(); ++id)
      if (robot.material_names[id] == actuator.name && robot.materials[id].amplitude == 0 &&
          !actuator.materials.empty())
        drawn[id] = actuator.materials.front();
  return drawn;
}

}  // namespace

std::vector<MaterialId> face_materials(const Robot& robot) {
  const SpringsByMass springs(robot);
  const std::vector<MaterialId> drawn = drawn_materials(robot);
  std::vector<MaterialId> materials;
  materials.reserve(robot.faces.size());
  for (const Face& face : robot.faces) {
    const Spring* longest = nullptr;
    for (const auto& [a, b] : {std::pair{face.a, face.b}, {face.b, face.c}, {face.c, face.a}}) {
      const Spring* spring = springs.between(a, b);
      if (spring && (!longest || spring->rest_length > longest->rest_length)) longest = spring;
    }
    materials.push_back(longest ? drawn[longest->material] : air);
  }
  return materials;
}

std::vector<render::Color> material_colors(std::span<const Material> materials, bool defaults) {
  Range frequencies, passive;
  for (const Material& material : materials)
    if (material.amplitude != 0)
      frequencies.add(material.frequency);
    else if (material.stiffness > 0)
      passive.add(material.stiffness);
  std::vector<render::Color> colors;
  for (const Material& material : materials) colors.push_back(color_of(material, frequencies, passive));
  if (!defaults) return colors;
  for (std::size_t id = base_material_count + 1; id < colors.size(); ++id) {
    const auto [first, second] = base_materials_of(static_cast<MaterialId>(id));
    colors[id] = render::mix(colors[first], colors[second], 0.5f);
  }
  return colors;
}

void set_activations(std::span<const Material> materials, double time, std::span<render::RenderMaterial> drawn) {
  float largest = 0;
  for (const Material& material : materials) largest = std::max(largest, std::abs(material.amplitude));
  for (std::size_t i = 0; i < materials.size(); ++i)
    drawn[i].activation = largest > 0 ? contraction(materials[i], time) / largest : 0;
}

}  // namespace mercury
