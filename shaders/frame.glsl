// The values of one picture, shared by all shaders; its twin is FrameBlock in render/renderer.cpp.
layout(std140, binding = 0) uniform Frame {
    mat4 view, projection, viewBefore;   // viewBefore: of the picture before
    // Of the picture; right and up reach its edges at distance 1, in an orthographic view at any.
    // Like the domain's size they are given where y is up and the ground's corner is 0, whatever is
    // up in the world.
    vec4 eye, right, up, forward;
    vec4 sky;                       // the world's up in the camera's axes
    vec4 picture;                   // width, height, samples, line width in px
    vec4 domain;                    // size in m, step of the ground's grid (0 = no ground)
    vec4 particle;                  // radius in m, smallest in px, px a metre at distance 1, fluids
    // Lowest value, 1 / span, row of the table; 1 = plain, 2 = plain in two dimensions.
    vec4 color;
    // Corners of the box of which fluid is shown, m; clipLow.w: 1 = solids are cut too.
    vec4 clipLow, clipHigh;
    vec4 look;                      // 1 = light, 1 = colours by logarithms, values that are shown
} frame;

// Whether a place is in the box.
bool isInside(vec3 at) {
    return !any(lessThan(at, frame.clipLow.xyz)) && !any(greaterThan(at, frame.clipHigh.xyz));
}
// Whether fluid there with this value is shown.
bool isShown(vec3 at, float value) {
    return isInside(at) && !(value < frame.look.z) && !(value > frame.look.w);
}

// A value as the scale of colours has it.
float scaled(float value) { return frame.look.y > 0.0 ? log(max(value, 1e-37)) : value; }

// The colour of a value.
vec3 tableColor(sampler2D tables, float value) {
    float at = clamp((scaled(value) - frame.color.x) * frame.color.y, 0.0, 1.0);
    return texelFetch(tables, ivec2(at * 255.0 + 0.5, int(frame.color.z)), 0).rgb;
}

// In an orthographic view all is seen as from distance 1, whatever its distance is.
bool isOrthographic() { return frame.projection[3][3] > 0.5; }
float divisor(float distance) {
    return -frame.projection[2][3] * distance + frame.projection[3][3];
}
// Depth in clip space, -1 to 1, of what is so far from the eye's plane; and back.
float clipDepth(float distance) {
    return (-frame.projection[2][2] * distance + frame.projection[3][2]) / divisor(distance);
}
float distanceOf(float depth) {
    return (frame.projection[3][2] - frame.projection[3][3] * depth) /
           (frame.projection[2][2] - frame.projection[2][3] * depth);
}

// What is seen at `at`, 0 to 1 from the lower left, and so far from the eye's plane: in the
// camera's axes.
vec3 placeAt(vec2 at, float distance) {
    vec2 edge = vec2(1.0 / frame.projection[0][0], 1.0 / frame.projection[1][1]);
    return vec3((2.0 * at - 1.0) * edge * divisor(distance), -distance);
}

const int tileSize = 8;   // px, see render/occlusion.h
