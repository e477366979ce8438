// A particle becomes a square that just holds its sphere.
layout(location = 0) in vec4 vertex;   // position, value
layout(binding = 0) uniform sampler2D tables;

layout(location = 0) flat out vec4 tint;    // linear colour, opacity
layout(location = 1) flat out vec3 shape;   // square / sphere, its radius in px and in depth

vec3 tableColor(float value) {
    float at = clamp((value - frame.color.x) * frame.color.y, 0.0, 1.0);
    return texelFetch(tables, ivec2(at * 255.0 + 0.5, int(frame.color.z)), 0).rgb;
}

void main() {
    bool wall = gl_VertexID >= int(frame.particle.w);
    vec4 place = frame.view * vec4(vertex.xyz, 1.0);
    bool solid = wall && vertex.w > 0.5;
    float radius = frame.particle.x * (wall && !solid ? 0.4 : 1.0);
    float pixels = max(radius * frame.particle.z / max(-place.z, 1e-6), frame.particle.y);

    vec3 color = frame.color.w > 0.0 ? vec3(0.25, 0.56, 0.90) : tableColor(vertex.w);
    if (wall) color = vec3(0.46, 0.49, 0.55);
    tint = vec4(color * color, wall && !solid ? 0.4 : 1.0);

    gl_Position = frame.projection * place;
    // The square's depth is the sphere's nearest point; the fragment goes back from there.
    vec4 front = frame.projection * vec4(place.xy, min(place.z + radius, -1e-6), 1.0);
    float depth = gl_Position.z / gl_Position.w, nearest = front.z / front.w;
    shape = vec3((pixels + 0.5) / pixels, pixels, 0.5 * (depth - nearest));
    if (nearest > -1.0) gl_Position.z = nearest * gl_Position.w;
    else shape.z = 0.0;
    gl_PointSize = 2.0 * pixels + 1.0;
}
