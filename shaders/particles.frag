// A lit sphere: normal, depth and soft edge come from the place within the square.
layout(location = 0) flat in vec4 tint;
layout(location = 1) flat in vec3 shape;
layout(location = 0) out vec4 result;
layout(depth_greater) out float gl_FragDepth;

void main() {
    vec2 at = (gl_PointCoord * 2.0 - 1.0) * vec2(shape.x, -shape.x);
    float inside = 1.0 - dot(at, at);
    // Distance to the edge in pixels, near the edge.
    float cover = 0.5 * inside * shape.y + 0.5;
    if (cover < (frame.picture.z > 1.0 ? 0.1 : 0.5)) discard;
    // Without samples to share, every second pixel lets through what is behind.
    bool odd = mod(gl_FragCoord.x + gl_FragCoord.y, 2.0) > 0.5;
    if (frame.picture.z < 2.0 && tint.a < 1.0 && odd) discard;
    vec3 normal = vec3(at, sqrt(max(inside, 0.0)));

    // In the camera's axes: a key light above the left shoulder, its highlight, and the sky.
    float key = max(dot(normal, vec3(-0.448, 0.647, 0.617)), 0.0);
    float shine = max(dot(normal, vec3(-0.249, 0.360, 0.899)), 0.0);
    shine *= shine; shine *= shine; shine *= shine; shine *= shine; shine *= shine;
    float sky = dot(normal, frame.sky.xyz);
    float edge = 1.0 - normal.z;
    vec3 light = vec3(0.34, 0.36, 0.41) + vec3(0.88, 0.86, 0.82) * key +
                 vec3(0.16, 0.18, 0.21) * sky;
    vec3 shade = tint.rgb * (light * (1.0 - 0.5 * edge * edge)) + 0.16 * shine;
    result = vec4(sqrt(shade), clamp(cover, 0.0, 1.0) * tint.a);
    gl_FragDepth = gl_FragCoord.z + shape.z * edge;
}
