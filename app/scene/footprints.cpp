// SPDX-License-Identifier: Apache-2.0
#include "app/scene/footprints.h"

#include <cmath>

namespace mercury {
namespace {

using render::Vector2;

constexpr double sampling = 1.0 / 60;                        // between looks at the ground [s]
constexpr float radius = 0.30f;                              // of a print, in short springs
constexpr float height = 0.02f;                              // up to which a mass touches the ground, in short springs
constexpr float depth_of_edge = 0.7f, depth_of_mass = 0.5f;  // of that of faces
constexpr float step = 0.25f;  // a part that slid so far makes another print, in short springs

// A length that nearly a quarter of the springs do not reach: the edge of a voxel, not its diagonals.
float short_spring(const Robot& robot) {
  std::vector<float> lengths;
  for (const Spring& spring : robot.springs) lengths.push_back(spring.rest_length);
  if (lengths.empty()) return 0;
  const auto quarter = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 5);
  std::ranges::nth_element(lengths, quarter);
  return *quarter;
}

Vector2 level(Vec3 p) { return {p.x, p.y}; }

// How far a part slides before it makes another print [m].
float step_of(const GroundContact& contact) { return std::max(step / radius * contact.radius, 1e-6f); }

// The cell of the ground in which the middle of a contact is; cells have the side of a step.
std::uint64_t cell_of(const GroundContact& contact) {
  const Vector2 middle = (1.0f / 3) * (contact.corners[0] + contact.corners[1] + contact.corners[2]);
  const auto place = [&](float x) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(x / step_of(contact))));
  };
  return std::uint64_t{place(middle.x)} << 32 | place(middle.y);
}

}  // namespace

FootprintObserver::FootprintObserver(const Simulation& simulation)
    : simulation_(simulation),
      interval_(std::max<std::int64_t>(1, std::llround(sampling / simulation.configuration().dt))) {
  for (std::size_t i = 0; i < simulation.size(); ++i) lengths_.push_back(short_spring(simulation.robot(i)));
}

GroundContacts FootprintObserver::contacts(std::span<const Vec3> positions,
                                           std::span<const Telemetry> telemetry) const {
  GroundContacts all{.time = simulation_.time(), .parts = {}};
  std::vector<bool> covered;
  for (std::size_t i = 0; i < lengths_.size(); ++i) {
    if (telemetry[i].exploded) continue;
    const Robot& robot = simulation_.robot(i);
    const auto own = positions.subspan(simulation_.mass_offsets()[i], robot.masses.size());
    const auto touches = [&](std::size_t mass) { return own[mass].z <= height * lengths_[i]; };
    covered.assign(own.size(), false);
    std::size_t touching = 0;
    for (std::size_t mass = 0; mass < own.size(); ++mass) touching += touches(mass);
    if (touching == 0) continue;
    const auto add = [&](std::size_t part, std::size_t a, std::size_t b, std::size_t c, float depth) {
      covered[a] = covered[b] = covered[c] = true;
      all.parts.push_back({.body = static_cast<std::uint32_t>(i),
                           .part = static_cast<std::uint32_t>(part),
                           .corners = {level(own[a]), level(own[b]), level(own[c])},
                           .radius = radius * lengths_[i],
                           .depth = depth});
    };
    const std::size_t faces = robot.faces.size();
    for (std::size_t face = 0; face < faces; ++face) {
      const std::array<std::size_t, 3> corners{robot.faces[face].a, robot.faces[face].b, robot.faces[face].c};
      if (touches(corners[0]) && touches(corners[1]) && touches(corners[2]))
        add(face, corners[0], corners[1], corners[2], 1);
    }
    // Each edge belongs to two faces, in both directions.
    for (std::size_t face = 0; face < faces; ++face) {
      const std::array<std::size_t, 3> corners{robot.faces[face].a, robot.faces[face].b, robot.faces[face].c};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = corners[k], b = corners[(k + 1) % 3];
        if (a < b && touches(a) && touches(b) && !(covered[a] && covered[b]))
          add(faces + 3 * face + k, a, b, b, depth_of_edge);
      }
    }
    for (std::size_t mass = 0; mass < own.size(); ++mass)
      if (touches(mass) && !covered[mass]) add(4 * faces + mass, mass, mass, mass, depth_of_mass);
  }
  return all;
}

void Footprints::go_to(double time, Later later) {
  if (later == Later::forget) cut(std::min(now_, time));
  now_ = time;
}

// Forgets what came after that time.
void Footprints::cut(double time) {
  if (known_ <= time) return;
  known_ = time;
  const auto end = std::ranges::upper_bound(prints_, time, {}, &Print::from);
  const bool fewer = end != prints_.end();
  prints_.erase(end, prints_.end());
  for (Print& print : prints_) print.until = std::min(print.until, time);
  if (fewer) count_latest();
}

void Footprints::count_latest() {
  latest_.clear();
  in_cell_.clear();
  for (std::size_t i = 0; i < prints_.size(); ++i) count(i);
}

void Footprints::count(std::size_t print) {
  latest_[prints_[print].contact.part] = print;
  in_cell_[cell_of(prints_[print].contact)] = print;
}

// A foot that comes back to its print within `whole_for` does not leave another one. A part that slid presses no sand
// that another part has pressed as deep.
Footprints::Print* Footprints::covering(double time, const GroundContact& contact) {
  const auto found = latest_.find(contact.part);
  if (found == latest_.end()) return nullptr;
  Print& last = prints_[found->second];
  float moved = 0;
  for (std::size_t k = 0; k < 3; ++k) moved = std::max(moved, (contact.corners[k] - last.contact.corners[k]).norm());
  if (moved <= step_of(contact) && time - last.until < whole_for) return &last;
  const auto there = in_cell_.find(cell_of(contact));
  if (there == in_cell_.end()) return nullptr;
  Print& pressed = prints_[there->second];
  return pressed.contact.depth >= contact.depth && time - pressed.until < whole_for ? &pressed : nullptr;
}

void Footprints::touch(double time, const GroundContact& contact) {
  if (time <= known_) return;
  if (Print* const print = covering(time, contact)) {
    print->until = time;
    return;
  }
  if (prints_.size() >= most_) forget_oldest();
  prints_.push_back({contact, time, time});
  count(prints_.size() - 1);
}

void Footprints::forget_oldest() {
  prints_.erase(prints_.begin(), prints_.begin() + static_cast<std::ptrdiff_t>(most_ / 8));
  count_latest();
}

void Footprints::know_until(double time) { known_ = std::max(known_, time); }

void Footprints::show(const Vector2& offset, std::vector<render::Print>& prints) const {
  for (const Print& print : prints_) {
    if (print.from > now_) break;
    const double age = now_ - std::min(print.until, now_);
    if (age >= gone_after) continue;
    const double share = std::clamp((gone_after - age) / (gone_after - whole_for), 0.0, 1.0);
    const auto& [a, b, c] = print.contact.corners;
    prints.push_back({.corners = {a + offset, b + offset, c + offset},
                      .radius = print.contact.radius,
                      .depth = static_cast<float>(share) * print.contact.depth});
  }
}

}  // namespace mercury
