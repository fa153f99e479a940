// SPDX-License-Identifier: Apache-2.0
// Packs the picture into the bytes of a file or an encoder, upper row first; four bytes per invocation.
layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D picture;  // gamma-encoded bytes, read without decoding
layout(std430, binding = 0) writeonly buffer Bytes { uint words[]; };
layout(location = 0) uniform ivec2 size;
layout(location = 1) uniform int format;  // PixelFormat

vec4 pixel(int x, int y) { return texelFetch(picture, ivec2(clamp(x, 0, size.x - 1), size.y - 1 - y), 0); }

// BT.709 luma and color differences, limited range.
float luma(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }
float limited_luma(vec3 c) { return (16.0 + 219.0 * luma(c)) / 255.0; }
float blue_difference(vec3 c) { return (128.0 + 224.0 * (c.b - luma(c)) / 1.8556) / 255.0; }
float red_difference(vec3 c) { return (128.0 + 224.0 * (c.r - luma(c)) / 1.5748) / 255.0; }

// Chroma is sited at the left pixel of a pair and halfway between two rows, the default of H.264.
vec3 chroma_average(int i, int j) {
  vec3 sum = vec3(0.0);
  for (int row = 0; row < 2; ++row)
    sum += 0.25 * pixel(2 * i - 1, 2 * j + row).rgb + 0.5 * pixel(2 * i, 2 * j + row).rgb +
           0.25 * pixel(2 * i + 1, 2 * j + row).rgb;
  return 0.5 * sum;
}

float byte_at(int k) {
  if (format == 0) {
    int p = k / 3;
    return pixel(p % size.x, p / size.x)[k % 3];
  }
  if (format == 1) {
    int p = k / 4;
    return pixel(p % size.x, p / size.x)[k % 4];
  }
  int plane = size.x * size.y;
  if (k < plane) return limited_luma(pixel(k % size.x, k / size.x).rgb);
  int quarter = plane / 4, half_width = size.x / 2;
  int p = k - plane;
  if (p < quarter) return blue_difference(chroma_average(p % half_width, p / half_width));
  p -= quarter;
  return red_difference(chroma_average(p % half_width, p / half_width));
}

void main() {
  int word = int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x);
  if (word >= words.length()) return;
  vec4 bytes = vec4(byte_at(4 * word), byte_at(4 * word + 1), byte_at(4 * word + 2), byte_at(4 * word + 3));
  words[word] = packUnorm4x8(bytes);
}
