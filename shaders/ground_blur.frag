// Averages the 4 x 4 pattern of ground_light.frag.
layout(binding = 0) uniform sampler2D source;
layout(location = 0) in vec2 place;
layout(location = 0) out float visibility;

void main() {
  vec2 texel = 1.0 / vec2(textureSize(source, 0));
  vec4 sum = textureGather(source, place + texel * vec2(-0.5, -0.5)) + textureGather(source, place + texel * vec2(1.5, -0.5)) +
             textureGather(source, place + texel * vec2(-0.5, 1.5)) + textureGather(source, place + texel * vec2(1.5, 1.5));
  visibility = dot(sum, vec4(1.0 / 16.0));
}
