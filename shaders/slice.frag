// What fluid is like on a plane: the colour of the table itself, without light, and lines of one
// value.
layout(location = 0) in vec2 at;
layout(binding = 0) uniform sampler2D tables;
layout(binding = 1) uniform sampler2D field;   // value, how much of what is around is fluid
layout(location = 3) uniform float contourStep;   // between lines, as the scale has it; 0 = none
layout(location = 0) out vec4 result;

void main() {
    vec2 here = texture(field, at).rg;
    float cover = clamp((here.y - 0.5) / max(fwidth(here.y), 1e-6) + 0.5, 0.0, 1.0);
    vec3 color = tableColor(tables, here.x);
    if (contourStep > 0.0) {
        float value = scaled(here.x) / contourStep, pixel = fwidth(value);
        float away = abs(fract(value - 0.5) - 0.5) / max(pixel, 1e-6);
        // Where nothing changes, round-off would draw lines.
        if (pixel > 1e-3) color *= 1.0 - 0.8 * clamp(0.6 * frame.picture.w + 0.5 - away, 0.0, 1.0);
    }
    if (cover < (frame.picture.z > 1.0 ? 0.1 : 0.5)) discard;
    result = vec4(color, cover);
}
