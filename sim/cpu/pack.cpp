#include "sim/cpu/pack.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace mercury::cpu {
namespace {

constexpr std::size_t cache_share = 512 * 1024;  // [bytes] of a core's own cache
constexpr std::size_t packs_a_thread = 4;
constexpr std::int64_t steps_at_once = 32;

// About what a step of a body touches [bytes].
std::size_t footprint(const Body& body) {
  return body.springs.rest_length.size() * 10 + body.springs.partners.size() * 4 + body.faces.size() * 4 +
         body.places.padded() * 128;
}

// Any order in which equal tables stand together.
int compare_tables(const Body& a, const Body& b) {
  return std::memcmp(a.materials.data(), b.materials.data(), max_materials * sizeof(Material));
}

}  // namespace

std::vector<Pack> pack(std::span<const Body> bodies, std::size_t threads) {
  std::vector<std::size_t> order(bodies.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return compare_tables(bodies[a], bodies[b]) < 0; });
  const std::size_t most = std::max<std::size_t>(1, bodies.size() / (packs_a_thread * threads));
  std::vector<Pack> packs;
  std::size_t bytes = 0;
  for (const std::size_t i : order) {
    const bool joins = !packs.empty() && packs.back().bodies.size() < most && bytes + footprint(bodies[i]) <= cache_share &&
                       compare_tables(bodies[packs.back().bodies.front()], bodies[i]) == 0;
    if (!joins) {
      packs.emplace_back();
      bytes = 0;
    }
    packs.back().bodies.push_back(i);
    bytes += footprint(bodies[i]);
  }
  return packs;
}

void advance(const Kernel& kernel, const Pack& pack, std::span<Body> bodies, const StepSetting& setting, const Clock& clock,
             std::int64_t steps) {
  Muscles muscles = muscles_of(bodies[pack.bodies.front()].materials, clock);
  Aligned<float> factors(static_cast<std::size_t>(std::min(steps, steps_at_once)) * max_materials);
  for (std::int64_t done = 0; done < steps; done += steps_at_once) {
    const std::int64_t now = std::min(steps_at_once, steps - done);
    kernel.fill_factors(muscles, factors.data(), now);
    for (const std::size_t i : pack.bodies) {
      Body& body = bodies[i];
      if (body.status.exploded_step >= 0) continue;
      const std::int64_t made = body.written && !accept_state(body) ? 0 : kernel.advance(body, setting, factors.data(), now);
      if (made < now) explode(body, clock.step + done + made);
    }
  }
}

}  // namespace mercury::cpu
