// A plane through the fluid, nearer by a particle's radius than it is: spheres that it cuts in half
// must not stand out of it.
layout(location = 0) uniform vec3 corner;
layout(location = 1) uniform vec3 across;
layout(location = 2) uniform vec3 along;
layout(location = 0) out vec2 at;   // 0 to 1

void main() {
    at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec4 place = frame.view * vec4(corner + at.x * across + at.y * along, 1.0);
    gl_Position = frame.projection * place;
    float near = -place.z - frame.particle.x;
    if (near > 0.0) gl_Position.z = clipDepth(near) * gl_Position.w;
}
