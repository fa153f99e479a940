// Depth alone; CUT: of a skin's back, which stands for what a cut lays open.
#ifdef CUT
#include "frame.glsl"
#include "cut.glsl"
layout(location = 1) in vec3 world;

void main() { gl_FragDepth = depth_of(point_of_cut(world - frame.eye.xyz)); }
#else
void main() {}
#endif
