layout(location = 0) in vec4 tint;
layout(location = 1) noperspective in float away;
layout(location = 2) flat in float halfWidth;
layout(location = 0) out vec4 result;

void main() {
    result = vec4(tint.rgb, tint.a * clamp(halfWidth + 0.5 - abs(away), 0.0, 1.0));
}
