// SPDX-License-Identifier: Apache-2.0
// From linear light to what a screen shows.

// Identity up to `shoulder`, so that colors of values keep their meaning; above it, bends toward 1 and toward white,
// like photographic film.
vec3 tone_mapped(vec3 light) {
  const float shoulder = 0.62;
  float peak = max(light.r, max(light.g, light.b));
  if (peak <= shoulder) return light;
  const float room = 1.0 - shoulder;
  float bent = 1.0 - room * room / (peak + room - shoulder);
  float bleach = 1.0 - 1.0 / (0.22 * (peak - bent) + 1.0);
  return mix(light * (bent / peak), vec3(bent), bleach);
}

vec3 gamma_encoded(vec3 light) {
  return mix(1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));
}
