// SPDX-License-Identifier: Apache-2.0
// The simplest scene: one triangle in front of a camera, and where its points must be in the picture.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/render/offscreen.h"

namespace mercury::render {

struct Mesh {
  std::vector<float> positions;
  std::vector<std::uint32_t> faces, springs;
  Body body() const { return {positions, faces, springs, {}, {}}; }
};

// A triangle that faces the camera `front()`.
inline Mesh triangle(float y = 0) {
  return {{-0.8f, y, -0.5f, 0.9f, y, -0.4f, 0.1f, y, 0.8f}, {0, 1, 2}, {0, 1, 1, 2, 2, 0}};
}

inline Camera front() { return {.eye = {0.4f, -4, 0.3f}, .target = {0, 0, 0.1f}}; }

// A scene without surroundings.
inline Scene plain() {
  Scene scene;
  scene.surroundings = Surroundings::none;
  return scene;
}

inline Image drawn(Renderer& renderer, const Scene& scene, const Camera& camera = front()) {
  renderer.draw(scene, camera);
  return read(renderer);
}

// An independent pinhole camera: similar triangles.
inline Vector2 pinhole(const Camera& camera, const Vector3& point, int width, int height) {
  const Vector3 forward = (camera.target - camera.eye).normalized();
  const Vector3 right = Vector3(forward.y, -forward.x, 0).normalized();
  const Vector3 up(right.y * forward.z - right.z * forward.y, right.z * forward.x - right.x * forward.z,
                   right.x * forward.y - right.y * forward.x);
  const Vector3 p = point - camera.eye;
  const float scale = float(height) / 2 / std::tan(camera.field_of_view / 2) / p.dot(forward);
  return {float(width) / 2 + scale * p.dot(right), float(height) / 2 - scale * p.dot(up)};
}

}  // namespace mercury::render
