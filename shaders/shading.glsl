// SPDX-License-Identifier: Apache-2.0
// Light on soft skin: key light, sky and ground. Needs frame.glsl.
const float pi = 3.14159265;

float fifth(float x) { return x * x * x * x * x; }

// Microfacet reflection: GGX distribution (Walter et al. 2007), Smith-Schlick visibility, Schlick's Fresnel term.
float specular(vec3 normal, vec3 to_light, vec3 to_eye, float roughness) {
  vec3 half_way = normalize(to_light + to_eye);
  float n_h = max(dot(normal, half_way), 0.0);
  float n_v = max(dot(normal, to_eye), 1e-3);
  float n_l = max(dot(normal, to_light), 0.0);
  float a2 = roughness * roughness * roughness * roughness;
  float d = n_h * n_h * (a2 - 1.0) + 1.0;
  float k = 0.5 * roughness * roughness;
  float visibility = 1.0 / (4.0 * (n_v * (1.0 - k) + k) * (n_l * (1.0 - k) + k));
  float fresnel = 0.04 + 0.96 * fifth(1.0 - max(dot(half_way, to_eye), 0.0));
  return a2 / (pi * d * d) * visibility * fresnel * n_l;
}

struct Surface {
  vec3 albedo;
  vec3 normal;
  float roughness;
  float softness;  // how far light scatters past the terminator, 0 to 1
};

// `key`: color of the key light, with shadow and caustics. `open`: share of the light of sky and ground that arrives.
vec3 lit(Surface s, vec3 to_eye, vec3 key, float open) {
  float n_l = dot(s.normal, frame.to_key.xyz);
  float wrap = 0.4 * s.softness;
  float wrapped = clamp((n_l + wrap) / (1.0 + wrap), 0.0, 1.0);
  // Light that has scattered inside the body takes on its color.
  vec3 scattered = mix(vec3(1.0), s.albedo, s.softness * smoothstep(0.5, 0.0, wrapped));
  vec3 diffuse = key * mix(max(n_l, 0.0), wrapped, s.softness) * scattered / 1.6;
  float upward = 0.5 + 0.5 * s.normal.z;
  // Light that is reflected between bright surfaces brightens corners in the surfaces' own color.
  vec3 filled = open / (1.0 - s.albedo * (1.0 - open) * 0.8);
  vec3 ambient = mix(frame.ground_light.rgb, frame.sky_light.rgb, upward) * filled;
  vec3 mirrored = reflect(-to_eye, s.normal);
  float grazing = fifth(1.0 - max(dot(s.normal, to_eye), 0.0));
  vec3 sheen = mix(frame.ground_light.rgb, frame.sky_light.rgb, smoothstep(-0.4, 0.6, mirrored.z)) *
               (0.04 + 0.5 * grazing * (1.0 - 0.6 * s.roughness)) * open;
  return s.albedo * (diffuse + ambient) + key * specular(s.normal, frame.to_key.xyz, to_eye, s.roughness) + sheen;
}
