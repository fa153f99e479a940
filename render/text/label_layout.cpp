// SPDX-License-Identifier: Apache-2.0
#include "render/text/label_layout.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace mercury::render {
namespace {

constexpr std::size_t best = 10;

float common_area(const Rectangle& a, const Rectangle& b) {
  const float width = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
  const float height = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
  return width > 0 && height > 0 ? width * height : 0;
}

std::array<Rectangle, 4> candidates(const LabelRequest& r, const Rectangle& picture) {
  const float middle_x = r.body.x + 0.5f * (r.body.width - r.width);
  const float middle_y = r.body.y + 0.5f * (r.body.height - r.height);
  std::array<Rectangle, 4> places{{{middle_x, r.body.y - r.height, r.width, r.height},
                                   {middle_x, r.body.y + r.body.height, r.width, r.height},
                                   {r.body.x + r.body.width, middle_y, r.width, r.height},
                                   {r.body.x - r.width, middle_y, r.width, r.height}}};
  for (Rectangle& place : places) {
    place.x = std::clamp(place.x, picture.x, std::max(picture.x, picture.x + picture.width - r.width));
    place.y = std::clamp(place.y, picture.y, std::max(picture.y, picture.y + picture.height - r.height));
  }
  return places;
}

// How much a name at `place` disturbs: the largest share that it covers of its own or of another body, and more than 1
// if it covers another name or what is taken otherwise.
float disturbance(const Rectangle& place, std::size_t own, std::span<const LabelRequest> requests,
                  std::span<const Rectangle> taken) {
  constexpr float own_weight = 0.3f;  // covering a part of its own body is no lie
  if (std::ranges::any_of(taken, [&](const Rectangle& other) { return common_area(place, other) > 0; })) return 2;
  float worst = 0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const Rectangle& body = requests[i].body;
    const float share = common_area(place, body) / std::max(1.0f, body.width * body.height);
    worst = std::max(worst, (i == own ? own_weight : 1.0f) * share);
  }
  return worst;
}

}  // namespace

std::optional<Rectangle> covered_by(const Bounds& box, const Camera& camera, int width, int height) {
  if (box.empty()) return std::nullopt;
  Vector2 low(1e30f, 1e30f), high(-1e30f, -1e30f);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 point((corner & 1) ? box.high.x : box.low.x, (corner & 2) ? box.high.y : box.low.y,
                        (corner & 4) ? box.high.z : box.low.z);
    const Vector3 seen = camera.project(point, width, height);
    if (seen.z < camera.near) continue;
    low = smallest(low, seen.xy());
    high = largest(high, seen.xy());
  }
  if (low.x > high.x || high.x < 0 || high.y < 0 || low.x > float(width) || low.y > float(height)) return std::nullopt;
  return Rectangle{low.x, low.y, high.x - low.x, high.y - low.y};
}

std::vector<std::optional<Rectangle>> place_labels(std::span<const LabelRequest> requests, const Rectangle& picture,
                                                   std::span<const Rectangle> covered) {
  // The share of a body that a name may cover. Among many bodies there is no room beside them, but there are few names.
  const float tolerated = requests.size() > most_named_bodies ? 1 : 0.08f;
  std::vector<std::size_t> order(requests.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    const LabelRequest &x = requests[a], &y = requests[b];
    if (x.forced != y.forced) return x.forced;
    return x.priority != y.priority ? x.priority > y.priority : x.depth < y.depth;
  });
  std::vector<std::optional<Rectangle>> placed(requests.size());
  std::vector<Rectangle> taken(covered.begin(), covered.end());
  std::size_t count = 0;
  for (const std::size_t i : order) {
    const LabelRequest& request = requests[i];
    if (!request.forced && requests.size() > most_named_bodies && count++ >= best) continue;
    Rectangle chosen;
    float least = 1e30f;
    for (const Rectangle& place : candidates(request, picture)) {
      const float disturbs = disturbance(place, i, requests, taken);
      if (disturbs >= least) continue;
      least = disturbs;
      chosen = place;
      if (least == 0) break;
    }
    if (least > 1 || (least > tolerated && !request.forced)) continue;
    placed[i] = chosen;
    taken.push_back(chosen);
  }
  return placed;
}

}  // namespace mercury::render
