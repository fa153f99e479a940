// SPDX-License-Identifier: Apache-2.0
// The mean of the pictures that accumulate.comp has added up.
layout(binding = 0) uniform sampler2D sum;
layout(location = 0) uniform float share;  // of one picture
layout(location = 0) out vec4 light;

void main() { light = share * texelFetch(sum, ivec2(gl_FragCoord.xy), 0); }
