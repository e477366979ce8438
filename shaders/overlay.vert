layout(location = 0) in vec2 place;     // px from the upper left corner
layout(location = 1) in vec2 texture_;
layout(location = 2) in vec4 color;
layout(location = 0) out vec2 at;
layout(location = 1) out vec4 tint;

void main() {
    at = texture_;
    tint = color;
    vec2 corner = 2.0 * place / frame.picture.xy - 1.0;
    gl_Position = vec4(corner.x, -corner.y, 0.0, 1.0);
}
