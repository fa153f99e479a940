#include "sim/cpu/pack.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace mercury::cpu {
namespace {

constexpr std::size_t cache_share = 512 * 1024;  // [bytes] of a core's own cache
constexpr std::size_t packs_a_thread = 4;
constexpr std::int64_t steps_at_once = 32;
// A call of fewer is not worth bringing states into lanes and back.
constexpr std::int64_t fewest_steps_together = 8;

// About what a step of a body touches [bytes].
std::size_t footprint(const Body& body) {
  return body.springs.rest_length.size() * 10 + body.springs.partners.size() * 4 + body.faces.size() * 4 +
         body.places.padded() * 128;
}

// Any order in which equal tables stand together.
int compare_tables(const Body& a, const Body& b) {
  return std::memcmp(a.materials.data(), b.materials.data(), max_materials * sizeof(Material));
}

// What one core steps at a stretch.
struct Unit {
  std::vector<std::size_t> bodies;
  bool together = false;
};

bool alike(const Body& a, const Body& b) {
  return a.build_key == b.build_key && compare_tables(a, b) == 0 && same_build(*a.robot, *b.robot);
}

// Bodies that are alike stand together in `order`. Groups are made of as many as there are lanes, or nearly, but not so
// that threads have nothing to do.
std::vector<Unit> cut(std::span<const Body> bodies, std::span<const std::size_t> order, std::size_t threads,
                      const Configuration& configuration) {
  std::vector<Unit> groups, singles;
  for (std::size_t first = 0; first < order.size();) {
    const Body& body = bodies[order[first]];
    std::size_t last = first + 1;
    if (fits_in_lockstep(body, configuration))
      while (last < order.size() && last - first < body.places.lanes && fits_in_lockstep(bodies[order[last]], configuration) &&
             alike(body, bodies[order[last]]))
        ++last;
    if (4 * (last - first) >= 3 * body.places.lanes)
      groups.push_back({{order.begin() + static_cast<std::ptrdiff_t>(first), order.begin() + static_cast<std::ptrdiff_t>(last)}, true});
    else
      for (std::size_t i = first; i < last; ++i) singles.push_back({{order[i]}});
    first = last;
  }
  const std::size_t kept = groups.size() >= packs_a_thread * threads ? groups.size() : groups.size() / threads * threads;
  for (std::size_t g = kept; g < groups.size(); ++g)
    for (const std::size_t i : groups[g].bodies) singles.push_back({{i}});
  groups.resize(kept);
  groups.insert(groups.end(), singles.begin(), singles.end());
  return groups;
}

// Whether all of a group can be stepped in lockstep now. (Pulls are looked after one by one.)
bool ready(const Lockstep& group, std::span<Body> bodies) {
  return std::ranges::all_of(group.bodies, [&](std::size_t i) {
    Body& body = bodies[i];
    return body.status.exploded_step < 0 && body.pulls.empty() && (!body.written || accept_state(body));
  });
}

void advance_alone(const Kernel& kernel, Body& body, const StepSetting& setting, const float* factors, std::int64_t step,
                   std::int64_t steps) {
  if (body.status.exploded_step >= 0) return;
  const std::int64_t made = body.written && !accept_state(body) ? 0 : kernel.advance(body, setting, factors, steps);
  if (made < steps) explode(body, step + made);
}

}  // namespace

// Contacts pick masses lane by lane, which only pays where positions and sums of a group are in the nearest cache.
bool fits_in_lockstep(const Body& body, const Configuration& configuration) {
  constexpr std::size_t nearest_cache_share = 24 * 1024;  // [bytes]
  const Land* const land = std::get_if<Land>(&configuration.environment);
  const std::size_t picked = body.robot->masses.size() * body.places.lanes * 3 * (sizeof(float) + sizeof(std::int32_t));
  return body.status.exploded_step < 0 && footprint_in_lockstep(*body.robot, body.places.lanes) <= cache_share &&
         (land == nullptr || !land->self_collision || picked <= nearest_cache_share);
}

std::vector<Pack> pack(std::span<const Body> bodies, std::size_t threads, const Configuration& configuration) {
  std::vector<std::size_t> order(bodies.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    const int tables = compare_tables(bodies[a], bodies[b]);
    return tables != 0 ? tables < 0 : bodies[a].build_key < bodies[b].build_key;
  });
  const std::size_t most = std::max<std::size_t>(1, bodies.size() / (packs_a_thread * threads));
  std::vector<Pack> packs;
  std::size_t count = 0, bytes = 0;
  const Body* before = nullptr;
  std::shared_ptr<const Build> build;
  for (Unit& unit : cut(bodies, order, threads, configuration)) {
    const Body& body = bodies[unit.bodies.front()];
    const std::size_t size = unit.together ? footprint_in_lockstep(*body.robot, body.places.lanes) : footprint(body);
    const bool joins = before != nullptr && count + unit.bodies.size() <= most && bytes + size <= cache_share &&
                       compare_tables(*before, body) == 0;
    if (!joins) {
      packs.emplace_back();
      count = bytes = 0;
    }
    count += unit.bodies.size();
    bytes += size;
    if (unit.together) {
      if (!build || !alike(*before, body)) build = std::make_shared<const Build>(build_of(*body.robot));
      packs.back().groups.push_back(make_lockstep(build, bodies, std::move(unit.bodies), configuration));
    } else {
      packs.back().bodies.push_back(unit.bodies.front());
    }
    before = &body;
  }
  return packs;
}

void advance(const Kernel& kernel, Pack& pack, std::span<Body> bodies, const StepSetting& setting, const Clock& clock,
             std::int64_t steps) {
  std::vector<Lockstep*> together;
  std::vector<std::size_t> apart = pack.bodies;
  const auto part = [&](const Lockstep& group) { apart.insert(apart.end(), group.bodies.begin(), group.bodies.end()); };
  for (Lockstep& group : pack.groups) {
    if (steps >= fewest_steps_together && ready(group, bodies)) {
      load(group, bodies);
      together.push_back(&group);
    } else {
      part(group);
    }
  }
  const std::size_t any = pack.groups.empty() ? pack.bodies.front() : pack.groups.front().bodies.front();
  Muscles muscles = muscles_of(bodies[any].materials, clock);
  Aligned<float> factors(static_cast<std::size_t>(std::min(steps, steps_at_once)) * max_materials);
  for (std::int64_t done = 0; done < steps; done += steps_at_once) {
    const std::int64_t now = std::min(steps_at_once, steps - done);
    kernel.fill_factors(muscles, factors.data(), now);
    std::erase_if(together, [&](Lockstep* group) {
      make_checkpoint(*group);
      if (kernel.advance_together(*group, setting, factors.data(), now)) return false;
      return_to_checkpoint(*group);
      store(*group, bodies);
      part(*group);
      pack.broken = true;
      return true;
    });
    for (const std::size_t i : apart) advance_alone(kernel, bodies[i], setting, factors.data(), clock.step + done, now);
  }
  for (const Lockstep* group : together) store(*group, bodies);
}

}  // namespace mercury::cpu
