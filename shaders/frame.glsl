// What all shaders of one picture share: FrameBlock of render/frame_block.h.
layout(std140, binding = 0) uniform Frame {
  mat4 view_projection;          // world to clip, depth reversed
  mat4 inverse_view_projection;
  mat4 view;                     // world to eye, which looks along -z
  vec4 eye;                      // world; w = time [s]
  vec4 to_key;                   // direction towards the key light
  vec4 key_light;                // linear light
  vec4 sky_light;                // from straight above
  vec4 ground_light;             // from straight below
  vec4 backdrop_high;            // what is seen far away, looking up and level
  vec4 backdrop_low;             // the same, looking down
  vec4 cut;                      // normal, offset; normal 0 = nothing is cut
  vec4 screen;                   // width, height, 1/width, 1/height [pixels]
} frame;
