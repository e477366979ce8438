// A particle of fluid as the square that holds its sphere, larger than it is, so that neighbours
// overlap.
layout(location = 0) in vec4 vertex;   // position, value
layout(binding = 0) uniform sampler2D tables;
layout(location = 0) uniform float scale;   // px of this pass / px of the picture

layout(location = 0) flat out vec3 tint;    // linear colour
layout(location = 1) flat out vec2 sphere;  // distance of its middle, radius, m

void main() {
    vec4 place = frame.view * vec4(vertex.xyz, 1.0);
    float radius = 1.5 * frame.particle.x, distance = -place.z;
    vec3 color = tableColor(tables, vertex.w);
    tint = color * color;
    sphere = vec2(distance, radius);
    gl_Position = frame.projection * vec4(place.xy, min(place.z + radius, -1e-6), 1.0);
    // Where its middle is seen, at the depth of its nearest point.
    if (distance > radius) gl_Position.xy *= divisor(distance - radius) / divisor(distance);
    gl_PointSize = 2.0 * scale * radius * frame.particle.z / max(divisor(distance), 1e-6);
    if (!isShown(vertex.xyz, vertex.w)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
