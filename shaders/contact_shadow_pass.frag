#version 450 core
#include "shared/contact_shadow.h"
// The factor by which the model's shadow on the floor darkens the background.
layout(std140, binding = 0) uniform ContactShadowBlock { ContactShadowUniforms shadow; };
layout(binding = 0) uniform sampler2D cover;
layout(location = 0) out vec4 factor;

void main() {
  vec3 pixel = vec3(gl_FragCoord.xy, 1.0);
  vec3 on_floor = vec3(dot(shadow.map_from_pixel[0].xyz, pixel), dot(shadow.map_from_pixel[1].xyz, pixel),
                       dot(shadow.map_from_pixel[2].xyz, pixel));
  // The cover is 0 at the border of the map, and beyond it.
  float dark = on_floor.z > 0.0 ? texture(cover, on_floor.xy / on_floor.z).r : 0.0;
  factor = vec4(vec3(1.0 - kContactShadowStrength * dark), 1.0);
}
