// A corner of a solid's surface, from its own axes into the picture.
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 outward;
layout(location = 0) uniform vec3 middle;
layout(location = 1) uniform mat3 axes;

layout(location = 0) out vec3 normal;   // in the camera's axes
layout(location = 1) out vec3 place;    // from the eye
layout(location = 2) out vec3 world;

void main() {
    world = middle + axes * corner;
    vec4 seen = frame.view * vec4(world, 1.0);
    normal = mat3(frame.view) * (axes * outward);
    place = isOrthographic() ? vec3(0.0, 0.0, -1.0) : seen.xyz;
    gl_Position = frame.projection * seen;
}
