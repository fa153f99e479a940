#include "render/frame_block.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace mercury::render {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3f;
using Eigen::Vector4f;

Vector4f with(const Vector3f& v, float w) { return {v.x(), v.y(), v.z(), w}; }

// Rounded up to a multiple of an eighth of its power of two, so that it changes in steps and not every frame.
float stepped(float size) {
  const float unit = std::exp2(std::floor(std::log2(std::max(size, 1e-6f)))) / 8;
  return unit * std::ceil(size / unit);
}

}  // namespace

Octave octave_of(float distance) {
  const float power = std::log2(std::max(distance, 1e-6f));
  const float whole = std::floor(power);
  const float t = std::clamp((power - whole - 0.35f) / 0.3f, 0.0f, 1.0f);
  // All of the double is the next power alone.
  return t < 1 ? Octave{std::exp2(whole), t * t * (3 - 2 * t)} : Octave{std::exp2(whole + 1), 0};
}

ShadowFit fit_shadow(const Bounds& casters, const Vector3f& to_key, int side) {
  const Vector3f back = to_key.normalized();
  const Vector3f right = Vector3f::UnitY().cross(back).normalized();
  const Vector3f up = back.cross(right);
  const Vector3f middle = casters.empty() ? Vector3f(0, 0, 0) : casters.center();
  const Vector3f half = casters.empty() ? Vector3f(1, 1, 1) : Vector3f(0.5f * (casters.high - casters.low));
  const auto reach = [&](const Vector3f& axis) { return half.dot(axis.cwiseAbs()); };
  ShadowFit fit;
  fit.width = stepped(2.1f * std::max({reach(right), reach(up), 1e-3f}));
  fit.depth = stepped(2.1f * std::max(reach(back), 1e-3f));
  // Whole texels, so that shadows do not crawl while bodies move.
  const float texel = fit.width / float(side);
  const float x = texel * std::round(middle.dot(right) / texel), y = texel * std::round(middle.dot(up) / texel);
  const float z = middle.dot(back);
  fit.matrix.setIdentity();
  fit.matrix.row(0) = with(right, -x).transpose() / fit.width;
  fit.matrix.row(1) = with(up, -y).transpose() / fit.width;
  fit.matrix.row(2) = with(-back, z).transpose() / fit.depth;
  fit.matrix.block<3, 1>(0, 3).array() += 0.5f;
  return fit;
}

FrameBlock frame_block(const Scene& scene, const Camera& camera, const Style& style, const ShadowFit& shadow,
                       const Bounds& bodies, int ground_side, int width, int height) {
  FrameBlock b;
  const float aspect = float(width) / float(height);
  b.view = camera.view();
  b.view_projection = camera.projection(aspect) * b.view;
  b.inverse_view_projection = b.view_projection.inverse();
  b.shadow = shadow.matrix;
  const float distance = (camera.eye - camera.target).norm();
  b.eye = with(camera.eye, float(std::fmod(scene.time, 3600.0)));
  b.to_key = with(style.to_key.normalized(), style.key_size);
  b.key_light = with(style.key_light, style.glow);
  b.sky_light = with(style.sky_light, 0);
  b.ground_light = with(style.ground_light, 0);
  b.backdrop_high = with(style.backdrop_high, 0);
  b.backdrop_low = with(style.backdrop_low, 0);
  b.floor_color = with(style.floor_color, 0);
  b.line_color = with(style.line_color, 0);
  b.fog = with(style.fog / distance, 0.55f * distance);
  b.cut = scene.cut ? with(scene.cut->normal, scene.cut->offset) : Vector4f(0, 0, 0, 1);
  b.screen = {float(width), float(height), 1 / float(width), 1 / float(height)};
  const float scale = 1 / std::tan(0.5f * camera.field_of_view);
  // Depth d of the buffer stands for the distance near far / (near + d (far - near)).
  b.depth = {camera.near, camera.far, aspect / scale, 1 / scale};
  b.shadow_size = {shadow.width, shadow.depth, 0, 0};
  // The floor's map of light reaches as far as shadows can fall.
  const Vector3f to_key = style.to_key.normalized();
  const float drop = std::max(0.0f, bodies.empty() ? 0.0f : bodies.high.z() - scene.floor) / std::max(to_key.z(), 0.2f);
  Bounds shade = bodies.empty() ? Bounds{Vector3f(-1, -1, 0), Vector3f(1, 1, 0)} : bodies;
  shade.extend(Bounds{shade.low, shade.high}.moved(-drop * to_key));
  const Vector3f margin = Vector3f::Constant(0.1f * shade.radius() + drop * style.key_size);
  const Vector3f size = shade.high - shade.low + 2 * margin;
  const float side = stepped(std::max(size.x(), size.y()));
  const float texel = side / float(ground_side);
  const auto corner = [&](float middle) { return texel * std::round((middle - 0.5f * side) / texel); };
  b.ground = {corner(shade.center().x()), corner(shade.center().y()), side, scene.floor};
  b.water = {float(scene.surroundings), style.caustics, bodies.empty() ? 0.0f : bodies.high.z(), distance};
  const Octave octave = octave_of(distance);
  b.octave = {octave.size, 2 * octave.size, octave.share_of_double, 0};
  return b;
}

}  // namespace mercury::render
