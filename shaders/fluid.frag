// Of a particle of fluid: how far its nearest point is, or what it adds to how thick fluid is and
// to the colour of what is near its surface.
layout(location = 0) flat in vec3 tint;
layout(location = 1) flat in vec2 sphere;
#ifdef THICKNESS
layout(binding = 1) uniform sampler2D distances;   // of the smooth surface, m; 0: no fluid
layout(binding = 2) uniform sampler2D scene;       // depths of what is no fluid
// Texels of `distances` and `scene` a pixel of this pass.
layout(location = 1) uniform vec2 perPixel;
layout(location = 0) out float thickness;          // m
layout(location = 1) out vec4 color;               // times its weight, its weight
#else
layout(location = 0) out float result;             // m from the eye's plane
layout(depth_greater) out float gl_FragDepth;
#endif

void main() {
    vec2 at = gl_PointCoord * 2.0 - 1.0;
    float inside = 1.0 - dot(at, at);
    if (inside <= 0.0) discard;
    float depth = sqrt(inside) * sphere.y;
#ifdef THICKNESS
    ivec2 there = min(ivec2(gl_FragCoord.xy * perPixel.y), textureSize(scene, 0) - 1);
    if (sphere.x > distanceOf(2.0 * texelFetch(scene, there, 0).r - 1.0)) discard;
    there = min(ivec2(gl_FragCoord.xy * perPixel.x), textureSize(distances, 0) - 1);
    float front = texelFetch(distances, there, 0).r;
    // Spheres overlap by the cube of their radius: what they hold is what particles hold.
    thickness = 2.0 * depth / (1.5 * 1.5);
    float weight = front > 0.0 ? inside * exp2(-max(sphere.x - front, 0.0) / sphere.y) : 0.0;
    color = vec4(tint * weight, weight);
#else
    result = max(sphere.x - depth, 1e-6);
    gl_FragDepth = 0.5 * clipDepth(result) + 0.5;
#endif
}
