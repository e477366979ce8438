// A line in space becomes a strip of constant width on the picture.
struct Segment { vec4 from, to, color; };   // from.w: width in px
layout(std430, binding = 0) readonly buffer Segments { Segment segments[]; };

layout(location = 0) uniform int first;

layout(location = 0) out vec4 tint;
layout(location = 1) noperspective out float away;   // px from the line's middle
layout(location = 2) flat out float halfWidth;

void main() {
    Segment s = segments[first + gl_InstanceID];
    vec4 ends[2] = vec4[](frame.view * vec4(s.from.xyz, 1.0), frame.view * vec4(s.to.xyz, 1.0));
    // Cut what is nearer than the near plane.
    float limit = -distanceOf(-1.0);
    for (int i = 0; i < 2; ++i)
        if (ends[i].z > limit && ends[1 - i].z < limit)
            ends[i] = mix(ends[i], ends[1 - i], (ends[i].z - limit) / (ends[i].z - ends[1 - i].z));
    vec4 a = frame.projection * ends[0], b = frame.projection * ends[1];
    vec2 along = (b.xy / b.w - a.xy / a.w) * frame.picture.xy;
    vec2 across = normalize(dot(along, along) > 1e-12 ? vec2(-along.y, along.x) : vec2(1.0, 0.0));
    float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
    halfWidth = 0.5 * s.from.w;
    away = side * (halfWidth + 1.0);
    tint = s.color;
    vec4 place = gl_VertexID < 2 ? a : b;
    gl_Position = place + vec4(across * away * 2.0 / frame.picture.xy * place.w, 0.0, 0.0);
}
