// Which way the smooth surface faces: x and y of its normal in the camera's axes, 1 within it and 0
// where it ends, m from the eye's plane or 0.
layout(binding = 0) uniform sampler2D distances;   // m; 0: no fluid
layout(location = 0) out vec4 result;

vec3 placeOf(ivec2 texel, float distance) {
    return placeAt((vec2(texel) + 0.5) / vec2(textureSize(distances, 0)), distance);
}

// The difference to whichever neighbour is nearer in depth: over edges there is no slope.
vec3 slope(ivec2 texel, ivec2 step, vec3 here, inout float inside) {
    ivec2 last = textureSize(distances, 0) - 1;
    float a = texelFetch(distances, min(texel + step, last), 0).r,
          b = texelFetch(distances, max(texel - step, ivec2(0)), 0).r;
    vec3 ahead = placeOf(texel + step, a) - here, back = here - placeOf(texel - step, b);
    if (a > 0.0 && b > 0.0) return abs(ahead.z) < abs(back.z) ? ahead : back;
    inside = 0.0;
    return a <= 0.0 ? back : ahead;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    float distance = texelFetch(distances, texel, 0).r, inside = 1.0;
    result = vec4(0.0);
    if (distance <= 0.0) return;
    vec3 here = placeOf(texel, distance);
    vec3 right = slope(texel, ivec2(1, 0), here, inside),
         up = slope(texel, ivec2(0, 1), here, inside);
    result = vec4(normalize(cross(right, up)).xy, inside, distance);
}
