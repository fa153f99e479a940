// Many samples of linear light to one pixel of the picture: tone-mapped first, so that bright edges stay smooth.
layout(binding = 0) uniform sampler2DMS samples;
layout(location = 0) in vec2 place;
layout(location = 0) out vec4 color;

// Identity up to `shoulder`, then bends towards 1: colours keep their values where they are not bright.
vec3 tone_mapped(vec3 light) {
  const float shoulder = 0.7;
  float peak = max(light.r, max(light.g, light.b));
  if (peak <= shoulder) return light;
  float room = 1.0 - shoulder;
  float bent = 1.0 - room * room / (peak + room - shoulder);
  vec3 scaled = light * (bent / peak);
  return mix(scaled, vec3(bent), 0.4 * (1.0 - 1.0 / (0.6 * (peak - bent) + 1.0)));
}

// Breaks up the steps of 8-bit gradients.
float dither(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))) - 0.5; }

void main() {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < SAMPLES; ++i) sum += tone_mapped(max(texelFetch(samples, ivec2(gl_FragCoord.xy), i).rgb, vec3(0.0)));
  vec3 mapped = sum / float(SAMPLES);
  // A step of the 8-bit code is worth more light where it is bright.
  color = vec4(mapped + dither(gl_FragCoord.xy) * (0.0004 + 0.008 * mapped), 1.0);
}
