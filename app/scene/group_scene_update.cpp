// SPDX-License-Identifier: Apache-2.0
// The part of GroupScene that changes with every frame.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

#include "app/scene/group_scene.h"
#include "mercury/distance.h"
#include "mercury/parallel.h"

namespace mercury {
namespace {

// In the unit of the longest distance of a picture, so that names can be compared.
std::string distance_text(float meters, float longest) {
  if (longest < 0.01f) return fmt::format("{:.1f} mm", 1000 * meters);
  if (longest < 1) return fmt::format("{:.1f} cm", 100 * meters);
  return fmt::format("{:.2f} m", meters);
}

// In slow motion with enough digits that the last one changes visibly.
std::string clock_of(double time, double speed) {
  const int digits = speed >= 1 ? 1 : std::clamp(1 + static_cast<int>(std::ceil(-std::log10(speed) - 1e-9)), 1, 5);
  return speed == 1 ? fmt::format("{:.1f} s", time) : fmt::format("{:.{}f} s   x{:g}", time, digits, speed);
}

}  // namespace

void GroupScene::update(double time, std::span<const Telemetry> telemetry, SceneDetails details) {
  activate(time, details.driven);
  scene_.materials = materials_;
  scene_.time = time;
  if (settings_.shown.clock) scene_.clock = clock_of(time, settings_.speed);
  place(telemetry);
  leave_footprints(time, details.contacts);
  order_.clear();
  scene_.ground_cover->bare_low = scene_.ground_cover->bare_high = render::GroundCover().bare_low;
  if (motion_.layout() == Layout::race)
    race(time);
  else if (settings_.shown.path)
    lengthen_paths(time);
  else
    scene_.paths = {};
  mark_senses(details.touches);
  if (settings_.shown.labels || settings_.shown.captions) write_labels(telemetry);
  color(time, std::move(details));
}

// The glow of the muscles.
void GroupScene::activate(double time, const DrivenMaterials& driven) {
  for (std::size_t i = 0; i < table_of_.size(); ++i) {
    if (tables_[table_of_[i]].driven || !driven.drives(i)) continue;
    const Table shared = tables_[table_of_[i]];
    --tables_[table_of_[i]].robots;
    use_table(i, new_table(shared.own, shared.materials, shared.defaults));
    tables_[table_of_[i]].driven = i;
  }
  for (const Table& table : tables_) {
    const auto drawn = std::span(materials_).subspan(table.first_material, table.materials.size());
    if (table.driven)
      set_activations(driven.of(*table.driven, table.materials), time, drawn);
    else
      set_activations(table.materials, time, drawn);
  }
}

void GroupScene::place(std::span<const Telemetry> telemetry) {
  exploded_.assign(placements_.size(), false);
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    placements_[i].faulty = exploded_[i] = telemetry[i].exploded;
    if (!telemetry[i].exploded) trails_[i].pass(telemetry[i].center_of_mass);
  }
  place_boxes();
  note_movers(telemetry);
  hide_wrecks(telemetry);
  place_patches();
  scene_.placements = placements_;
}

// Offsets and boxes of the robots' last places.
void GroupScene::place_boxes() {
  bounds_.assign(placements_.size(), {});
  last_boxes_ = camera_boxes_ = bounds_;
  shown_offsets_.resize(placements_.size());
  const bool all_exploded = std::ranges::all_of(exploded_, std::identity());
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    const render::Vector3 wanted = motion_.offset_of(offsets_[i], rooms_[i], trails_[i]);
    shown_offsets_[i] = placements_[i].offset = wanted + held_.correction(i, wanted);
    last_boxes_[i] = rest_[i].moved(render::Vector3(trails_[i].last()) + shown_offsets_[i]);
    if (exploded_[i] && !all_exploded) continue;
    bounds_[i] = last_boxes_[i];
    camera_boxes_[i] = motion_.camera_box(bounds_[i], offsets_[i], rooms_[i]);
    if (motion_.layout() != Layout::grid) continue;
    if (seeks_target_[i]) camera_boxes_[i].extend(render::Vector3(environment_.target) + shown_offsets_[i]);
    if (seeks_light_[i]) camera_boxes_[i].extend(render::Vector3(environment_.light) + shown_offsets_[i]);
  }
}

// Swimmers, which carry water along.
void GroupScene::note_movers(std::span<const Telemetry> telemetry) {
  movers_.clear();
  const std::size_t count = placements_.size() > most_with_extras ? 0 : placements_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const render::Vector3 velocity(telemetry[i].velocity);
    if (exploded_[i] || hidden_[i] || !velocity.is_finite()) continue;
    const render::Vector3 size = rest_[i].high - rest_[i].low;
    movers_.push_back({bounds_[i].center(), (size.x + size.y + size.z) / 6, velocity});
  }
  scene_.movers = movers_;
}

// On land, the ground slides under each robot that stays in its cell.
void GroupScene::place_patches() {
  patches_.clear();
  if (!settings_.hero && motion_.layout() == Layout::cells && motion_.on_land() &&
      scene_.surroundings == render::Surroundings::land)
    for (std::size_t i = 0; i < placements_.size(); ++i) {
      if (placements_[i].hidden) continue;
      const render::Vector2 middle = (offsets_[i] + rooms_[i].center).xy();
      patches_.push_back({middle, 1.04f * rooms_[i].radius, -shown_offsets_[i].xy()});
    }
  scene_.patches = patches_;
}

// A robot that was torn apart would cover everything else, so only its name is shown where it was last.
void GroupScene::hide_wrecks(std::span<const Telemetry> telemetry) {
  constexpr float most_strain = 3;  // of a wreck that is drawn
  shown_texts_ = texts_;
  torn_.assign(placements_.size(), false);
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    torn_[i] = exploded_[i] && !(telemetry[i].largest_strain <= most_strain);
    placements_[i].hidden = hidden_[i] || torn_[i];
    if (torn_[i] && !hidden_[i])
      shown_texts_.push_back({.at = render::Vector3(trails_[i].last()) + shown_offsets_[i],
                              .text = fmt::format("{} exploded at {:.4g} s", names_[i], telemetry[i].exploded_at),
                              .free = true});
  }
  scene_.texts = shown_texts_;
}

// In cells, prints move with the ground below the robot, and end with it. There are none in races: a robot's way in its
// lane is not the one that it went.
void GroupScene::leave_footprints(double time, std::span<const GroundContacts> contacts) {
  const bool shows =
      settings_.footprints && scene_.surroundings == render::Surroundings::land && motion_.layout() != Layout::race;
  prints_of_robots_.resize(footprints_.size());
  parallel_for(0, footprints_.size(), [&](std::size_t i) {
    Footprints& own = footprints_[i];
    own.go_to(time, later_);
    for (const GroundContacts& then : contacts) {
      for (const GroundContact& contact : std::ranges::equal_range(then.parts, i, {}, &GroundContact::body))
        own.touch(then.time, contact);
      own.know_until(then.time);
    }
    std::vector<render::Print>& prints = prints_of_robots_[i];
    prints.clear();
    if (!shows || placements_[i].hidden) return;
    own.show(shown_offsets_[i].xy(), prints);
    if (patches_.empty()) return;
    const render::Vector2 middle = (offsets_[i] + rooms_[i].center).xy();
    std::erase_if(prints,
                  [&](const render::Print& print) { return (print.corners[0] - middle).norm() > rooms_[i].radius; });
  });
  prints_.clear();
  for (const std::vector<render::Print>& prints : prints_of_robots_)
    prints_.insert(prints_.end(), prints.begin(), prints.end());
  scene_.prints = prints_;
}

void GroupScene::lengthen_paths(double time) {
  constexpr float step = 0.02f, reach = 1.2f, bar = 0.12f;  // of a room's radius
  paths_.clear();
  marks_.clear();
  marks_.reserve(trails_.size());  // paths refer to it
  for (std::size_t i = 0; i < trails_.size(); ++i) {
    const float radius = rooms_[i].radius;
    if (!exploded_[i]) trails_[i].lengthen(step * radius, time, later_);
    const bool wake = motion_.layout() == Layout::cells;
    const auto points = wake ? trails_[i].wake(reach * radius) : trails_[i].points();
    const auto body = static_cast<std::uint32_t>(i);
    const render::Color color = render::category_color(static_cast<int>(i));
    paths_.push_back({.body = body, .points = points, .color = color});
    if (!wake) continue;
    marks_.push_back(marks_of(trails_[i], points, mark_distance_, bar * radius));
    for (std::size_t at = 0; at < marks_.back().size(); at += 6)
      paths_.push_back(
          {.body = body, .points = std::span(marks_.back()).subspan(at, 6), .color = color, .fades = false});
  }
  scene_.paths = paths_;
}

namespace {

// A circle around a point, across an axis.
void add_circle(std::vector<std::vector<float>>& lines, Vec3 at, float radius, std::size_t axis) {
  constexpr int corners = 32;
  std::vector<float>& line = lines.emplace_back();
  for (int k = 0; k <= corners; ++k) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / corners;
    const float u = radius * std::cos(angle), v = radius * std::sin(angle);
    const std::array<std::array<float, 3>, 3> offsets{{{0, u, v}, {u, 0, v}, {u, v, 0}}};
    const auto& [x, y, z] = offsets[axis];
    line.insert(line.end(), {at.x + x, at.y + y, at.z + z});
  }
}

// Rays around a point, from one distance to another.
void add_rays(std::vector<std::vector<float>>& lines, Vec3 at, float from, float to) {
  for (const Vec3 ray : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
    const Vec3 a = at + from * ray, b = at + to * ray;
    lines.push_back({a.x, a.y, a.z, b.x, b.y, b.z});
  }
}

}  // namespace

// What robots sense: rings where they feel the ground, brighter where more of a sensor's masses do; three circles
// around the target, the same with rays around the light, and beside each robot a line toward it. In cells, where
// robots stay, there is no place for target and light.
void GroupScene::mark_senses(std::span<const TouchMark> touches) {
  constexpr float share = 0.12f;              // of a room's radius: circles
  constexpr float begin = 0.75f, end = 1.1f;  // the same: the line beside a robot
  constexpr render::Color of_target = render::rgb(0xffc233), of_light = render::rgb(0xfff3b0),
                          of_touch = render::rgb(0xff9d2e);
  sense_lines_.clear();
  struct Mark {
    std::uint32_t body;
    std::size_t first, count;  // of the lines
    render::Color color;
  };
  std::vector<Mark> marks;
  const auto mark = [&](const std::vector<bool>& sensed_by, Vec3 goal, render::Color color, bool rays) {
    const auto one = std::ranges::find(sensed_by, true);
    if (one == sensed_by.end()) return;
    const float radius = share * rooms_[static_cast<std::size_t>(one - sensed_by.begin())].radius;
    const std::size_t first = sense_lines_.size();
    for (std::size_t axis = 0; axis < 3; ++axis) add_circle(sense_lines_, goal, (rays ? 0.7f : 1.0f) * radius, axis);
    if (rays) add_rays(sense_lines_, goal, radius, 1.6f * radius);
    const std::size_t around = sense_lines_.size() - first;
    for (std::size_t i = 0; i < sensed_by.size(); ++i) {
      if (!sensed_by[i] || placements_[i].hidden) continue;
      const auto body = static_cast<std::uint32_t>(i);
      if (motion_.layout() != Layout::cells) marks.push_back({body, first, around, color});
      const Vec3 center = trails_[i].last(), way = goal - center;
      const float distance = length(way), room = rooms_[i].radius;
      if (exploded_[i] || distance < end * room) continue;
      const Vec3 a = center + begin * room / distance * way, b = center + end * room / distance * way;
      marks.push_back({body, sense_lines_.size(), 1, color});
      sense_lines_.push_back({a.x, a.y, a.z, b.x, b.y, b.z});
    }
  };
  mark(seeks_target_, environment_.target, of_target, false);
  mark(seeks_light_, environment_.light, of_light, true);
  for (const TouchMark& touch : touches) {
    if (placements_[touch.body].hidden) continue;
    constexpr std::array radii{0.9f, 0.5f};
    render::Color color = of_touch;
    color.a = static_cast<std::uint8_t>(std::lround(255 * (0.3f + 0.7f * touch.share)));
    marks.push_back({touch.body, sense_lines_.size(), radii.size(), color});
    for (const float radius : radii)
      add_circle(sense_lines_, {touch.center.x, touch.center.y, 0.02f * touch.radius}, radius * touch.radius, 2);
  }
  if (marks.empty()) return;
  std::vector<render::Path> paths(scene_.paths.begin(), scene_.paths.end());
  for (const Mark& one : marks)
    for (std::size_t line = one.first; line < one.first + one.count; ++line)
      paths.push_back({.body = one.body, .points = sense_lines_[line], .color = one.color, .fades = false});
  paths_ = std::move(paths);
  scene_.paths = paths_;
}

void GroupScene::race(double time) {
  std::vector<float> progress;
  std::vector<Lane> lanes;
  float lowest = 1e30f, farthest = 0;
  for (std::size_t i = 0; i < trails_.size(); ++i) {
    const float way = motion_.progress_of(trails_[i]);
    const render::Vector3 start = offsets_[i] + rooms_[i].center;
    progress.push_back(exploded_[i] ? -1 : way);
    lanes.push_back({start, rooms_[i].radius, way, render::category_color(static_cast<int>(i))});
    lowest = std::min(lowest, start.z - 0.8f * rooms_[i].radius);
    farthest = std::max(farthest, way);
  }
  mark_times_.update(time, progress);
  const std::size_t step = marks_per_line(mark_distance_, farthest);
  // On land just above the ground, so that the lines are not hidden by it.
  const float height = motion_.on_land() ? 0.01f * mark_distance_ : lowest;
  course_.draw(lanes, motion_.along(), height, mark_times_, step, settings_.theme);
  scene_.paths = course_.lines();
  // No grass grows on the lanes.
  render::Bounds bare;
  for (const render::Path& path : course_.lines())
    for (std::size_t i = 0; i < path.points.size(); i += 3) bare.extend(render::Vector3(path.points.data() + i));
  if (motion_.on_land()) {
    scene_.ground_cover->bare_low = bare.low.xy();
    scene_.ground_cover->bare_high = bare.high.xy();
  }
  std::ranges::copy(course_.numbers(), std::back_inserter(shown_texts_));
  scene_.texts = shown_texts_;
  order_ = order_text(mark_times_, step, names_);
}

void GroupScene::write_labels(std::span<const Telemetry> telemetry) {
  std::vector<float> distances;
  for (std::size_t i = 0; i < trails_.size(); ++i)
    distances.push_back(telemetry[i].exploded ? -1
                                              : static_cast<float>(distance_between(
                                                    trails_[i].start(), telemetry[i].center_of_mass, environment_)));
  // No ranks before a robot has moved.
  const float longest = distances.empty() ? 0 : std::ranges::max(distances);
  const bool ranked = trails_.size() > 1 && longest > 1e-3f;
  labels_.clear();
  for (std::size_t i = 0; i < trails_.size(); ++i) {
    const auto rank = 1 + std::count_if(distances.begin(), distances.end(), [&](float d) { return d > distances[i]; });
    std::string text = names_[i];
    if (telemetry[i].exploded)
      text += fmt::format("\nexploded at {:.1f} s", telemetry[i].exploded_at);
    else if (settings_.shown.labels)
      text += fmt::format("\n{}{}", distance_text(distances[i], longest), ranked ? fmt::format("   #{}", rank) : "");
    if (!torn_[i])
      labels_.push_back({.body = static_cast<std::uint32_t>(i),
                         .text = text,
                         .priority = distances[i],
                         .forced = placements_[i].selected});
  }
  scene_.labels = labels_;
}

// The robots whose values count for the scale, among those that are drawn.
std::vector<bool> GroupScene::in_view() const {
  std::vector<bool> all(placements_.size(), true);
  if (!seen_ || settings_.scale_all) return all;
  constexpr int size = 1000;  // pixels of a picture's height
  const auto& [camera, aspect] = *seen_;
  const int width = static_cast<int>(aspect * size);
  std::vector<bool> seen(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const render::Vector3 middle = last_boxes_[i].center(), at = camera.project(middle, width, size);
    seen[i] = at.z > camera.near && at.x >= 0 && at.x <= static_cast<float>(width) && at.y >= 0 &&
              at.y <= static_cast<float>(size);
  }
  return std::ranges::find(seen, true) == seen.end() ? all : seen;
}

// Fits the scale to the values that are visible: those of robots that are neither hidden nor have exploded, and of what
// is shown of them.
void GroupScene::fit_scale(double time) {
  const render::Show& show = scene_.show;
  const ColorValues& values = details_.values;
  const bool on_springs = !values.spring.empty() && (show.springs && !show.skin);
  const bool on_faces = !values.face.empty() && !on_springs && (show.skin || values.mass.empty());
  const bool on_masses = !values.mass.empty() && !on_springs && !on_faces;
  const std::vector<float>& all = on_faces ? values.face : on_masses ? values.mass : values.spring;
  const std::vector<std::size_t>& counts = on_faces ? face_counts_ : on_masses ? mass_counts_ : spring_counts_;
  std::vector<bool> counted = in_view();
  std::vector<ValueRange> ranges;
  std::size_t first = 0;
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    counted[i] = counted[i] && !placements_[i].hidden && !placements_[i].faulty;
    if (counted[i] && counts[i] > 0) ranges.push_back({first, counts[i]});
    first += counts[i];
  }
  if (all.size() != first) ranges.clear();
  const bool others = counted != counted_ || show.skin != counted_show_.skin || show.springs != counted_show_.springs;
  counted_ = std::move(counted);
  counted_show_ = show;
  scale_.fit(time, sample(all, ranges), others);
}

void GroupScene::color(double time, SceneDetails details) {
  details_ = std::move(details);
  fit_scale(time);
  scene_.face_values = details_.values.face;
  scene_.mass_values = details_.values.mass;
  scene_.spring_values = details_.values.spring;
  scene_.scale = scale_.scale();
  scene_.arrows = details_.arrows;
  scene_.caption = settings_.caption;
  if (!scene_.caption.empty() && !details_.arrow_key.empty()) scene_.caption += "\n";
  scene_.caption += details_.arrow_key;
  const bool marked = motion_.layout() == Layout::cells && settings_.shown.path && settings_.shown.scale_bar;
  const std::string note = marked ? fmt::format("a mark every {:g} m of a trail", mark_distance_) : order_;
  if (!scene_.caption.empty() && !note.empty()) scene_.caption += "\n";
  scene_.caption += note;
  if (settings_.board) scene_.legend = settings_.board->legend;
  if (settings_.board || !settings_.shown.legend) return;
  scene_.legend = settings_.color->has_values() ? scale_.legend() : materials_legend_;
}

}  // namespace mercury
