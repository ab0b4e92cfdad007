#version 450 core
// The shading that all methods share: face normal from derivatives, tint by height. No method needs a
// normal map, and frames per second compare methods, not lighting models.

#define BLOCK(binding_, name_) layout(std140, binding = binding_) uniform name_
#define LODBENCH_FRAME_BINDING 0
#define LODBENCH_FROZEN_BINDING 1
#include "common/blocks.glsl"

in vec3 lodbench_position;
layout(location = 0) out vec4 color;

vec3 height_tint(float t) {
    const vec3 lowland = vec3(0.28, 0.42, 0.22);
    const vec3 upland = vec3(0.52, 0.47, 0.33);
    const vec3 rock = vec3(0.50, 0.47, 0.45);
    const vec3 snow = vec3(0.95, 0.96, 0.98);
    vec3 tint = mix(lowland, upland, smoothstep(0.02, 0.30, t));
    tint = mix(tint, rock, smoothstep(0.30, 0.48, t));
    return mix(tint, snow, smoothstep(0.48, 0.70, t));
}

// Times the power of two that makes its greatest coordinate one of 0.5 to 1. Exact: the normal has the same
// bits as without, but where a pixel shows so much ground (1e9 m) that the fourth power of it overflows.
vec3 scaled_down(vec3 along) {
    vec3 size = abs(along);
    int exponent;
    frexp(max(max(size.x, size.y), size.z), exponent);
    return ldexp(along, ivec3(-exponent));
}

void main() {
    if (tint.z > 0.5) {
        color = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
    vec3 normal = normalize(cross(scaled_down(dFdx(lodbench_position)), scaled_down(dFdy(lodbench_position))));
    if (normal.z < 0.0) normal = -normal;
    float diffuse = max(dot(normal, light.xyz), 0.0);
    float height = clamp((lodbench_position.z - tint.x) * tint.y, 0.0, 1.0);
    color = vec4(height_tint(height) * (0.25 + 0.85 * diffuse), 1.0);
}
