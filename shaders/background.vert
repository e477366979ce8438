// One triangle over the whole picture.
layout(location = 0) out vec3 ray;
layout(location = 1) out float height;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    ray = frame.forward.xyz;
    if (!isOrthographic()) ray += corner.x * frame.right.xyz + corner.y * frame.up.xyz;
    height = 0.5 + 0.5 * corner.y;
    gl_Position = vec4(corner, 0.0, 1.0);
}
