// SPDX-License-Identifier: Apache-2.0
#include "render/passes/quality.h"

#include <array>
#include <stdexcept>
#include <utility>

#include "render/context/programs.h"

namespace mercury::render {
namespace {

constexpr std::array<std::pair<Quality, std::string_view>, 4> quality_names{{
    {Quality::automatic, "auto"},
    {Quality::low, "low"},
    {Quality::medium, "medium"},
    {Quality::high, "high"},
}};

}  // namespace

std::string_view name_of(Quality quality) {
  for (const auto& [value, name] : quality_names)
    if (value == quality) return name;
  return "?";
}

Quality quality_named(std::string_view name) {
  for (const auto& [value, known] : quality_names)
    if (known == name) return value;
  throw std::invalid_argument("'" + std::string(name) + "' is not a quality; give auto, low, medium or high");
}

QualitySettings settings_of(Quality quality) {
  QualitySettings s;
  if (quality == Quality::medium) {
    s.shadow_side = 2048;
    s.ground_side = 1024;
    s.caustics_cells = 110;
    s.shadow_blockers = 8;
    s.shadow_taps = 12;
    s.skin_blockers = 5;
    s.skin_taps = 8;
    s.occlusion_taps = 12;
    s.particles = 900;
    s.prints_side = 1536;
    s.lens_samples = 64;
    s.front_light = true;
  } else if (quality == Quality::high) {
    s.shadow_side = 4096;
    s.ground_side = 2048;
    s.caustics_side = 512;
    s.caustics_cells = 110;
    s.shadow_blockers = 16;
    s.shadow_taps = 24;
    s.skin_blockers = 12;
    s.skin_taps = 24;
    s.occlusion_taps = 24;
    s.particles = 1500;
    s.prints_side = 2048;
    s.lens_samples = 128;
    s.front_light = true;
  }
  return s;
}

std::string QualitySettings::defines() const {
  return define("SAMPLES", samples) + define("SHADOW_BLOCKERS", shadow_blockers) + define("SHADOW_TAPS", shadow_taps) +
         define("OCCLUSION_TAPS", occlusion_taps) + define("DEPTH_STEP", front_light ? 2 : 1);
}

std::string QualitySettings::skin_defines() const {
  return define("SAMPLES", samples) + define("SHADOW_BLOCKERS", skin_blockers) + define("SHADOW_TAPS", skin_taps);
}

}  // namespace mercury::render
