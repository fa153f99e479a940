// SPDX-License-Identifier: Apache-2.0
// Finds room for names beside bodies, without covering other names or other bodies.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "render/camera.h"
#include "render/text/overlay.h"

namespace mercury::render {

struct LabelRequest {
  Rectangle body;               // what the body covers of the picture
  float width = 0, height = 0;  // of the name with its margin [pixels]
  float depth = 0;              // of the body [m]; of equal priorities, near ones are placed first
  float priority = 0;           // higher ones are placed first
  bool forced = false;          // shown even where it covers a body
};

// With more bodies than this, only forced names and the best ten are shown.
constexpr std::size_t most_named_bodies = 24;

// The part of a picture of this size that a box covers; nothing if it is behind the eye or outside the picture.
std::optional<Rectangle> covered_by(const Bounds& box, const Camera& camera, int width, int height);

// Where each name goes, in the order of the requests; nothing for those without room. Names never cover each other. A
// name is above its body, else below it, else beside it, inside `picture` and off what is `covered` by other things.
std::vector<std::optional<Rectangle>> place_labels(std::span<const LabelRequest> requests, const Rectangle& picture,
                                                   std::span<const Rectangle> covered = {});

}  // namespace mercury::render
