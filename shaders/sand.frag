// SPDX-License-Identifier: Apache-2.0
// One tile of sand: the slopes of its ripples, grain, and patches of many sizes. Drawn once.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 tile;

float hash(ivec2 p, int period) {
  p = (p % period + period) % period;
  uint n = uint(p.x) * 1973u + uint(p.y) * 9277u + uint(period) * 26699u;
  n = (n << 13u) ^ n;
  n = n * (n * n * 15731u + 789221u) + 1376312589u;
  return float(n & 0xffffffu) / float(0xffffff);
}

// Smooth, repeating noise with `period` cells per tile.
float noise(vec2 p, int period) {
  p *= float(period);
  ivec2 cell = ivec2(floor(p));
  vec2 f = smoothstep(0.0, 1.0, p - vec2(cell));
  return mix(mix(hash(cell, period), hash(cell + ivec2(1, 0), period), f.x),
             mix(hash(cell + ivec2(0, 1), period), hash(cell + ivec2(1, 1), period), f.x), f.y);
}

float height(vec2 p) {
  vec2 bent = p + 0.05 * vec2(noise(p, 3), noise(p.yx + 0.37, 3)) + 0.02 * vec2(noise(p, 7), noise(p + 0.5, 8));
  float ripple = sin(6.2831853 * (3.0 * bent.x + 13.0 * bent.y));
  ripple = 1.0 - pow(0.5 - 0.5 * ripple, 0.7);
  return 0.010 * ripple * (0.55 + 0.45 * noise(p, 4)) + 0.02 * noise(p, 5) + 0.0016 * noise(p, 96);
}

void main() {
  const float d = 1.0 / 512.0;
  vec2 slope = vec2(height(uv + vec2(d, 0.0)) - height(uv - vec2(d, 0.0)),
                    height(uv + vec2(0.0, d)) - height(uv - vec2(0.0, d))) / (2.0 * d);
  float grain = 0.5 + 0.30 * (noise(uv, 160) - 0.5) + 0.25 * (noise(uv, 6) - 0.5) + 0.2 * (noise(uv, 40) - 0.5);
  float patches = 0.0, weight = 0.5;
  for (int period = 3; period < 200; period *= 2) {
    patches += weight * noise(uv + 0.31 * float(period), period);
    weight *= 0.5;
  }
  tile = vec4(0.5 + 0.5 * slope, grain, patches);
}
