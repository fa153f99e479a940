// Averages the 4 x 4 pattern of occlusion.frag, over what lies at the same distance.
layout(binding = 0) uniform sampler2D source;
layout(location = 0) in vec2 place;
layout(location = 0) out vec2 result;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(source, 0) - 1;
  float range = texelFetch(source, texel, 0).g;
  float sum = 0.0, weights = 0.0;
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x) {
      vec2 value = texelFetch(source, clamp(texel + ivec2(x, y), ivec2(0), last), 0).rg;
      float weight = max(0.0, 1.0 - abs(value.g - range) / range * 30.0) + 1e-4;
      sum += weight * value.r;
      weights += weight;
    }
  result = vec2(sum / weights, range);
}
