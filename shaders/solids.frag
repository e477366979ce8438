// The light of particles.frag on a matt surface, from whichever side it is seen.
layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 place;
layout(location = 2) in vec3 world;
layout(location = 0) out vec4 result;

void main() {
    if (frame.clipLow.w > 0.5 && !isInside(world)) discard;
    vec3 n = normalize(normal);
    if (dot(n, place) > 0.0) n = -n;
    float key = max(dot(n, vec3(-0.448, 0.647, 0.617)), 0.0);
    float sky = dot(n, frame.sky.xyz);
    vec3 light = vec3(0.34, 0.36, 0.41) + vec3(0.80, 0.78, 0.74) * key +
                 vec3(0.16, 0.18, 0.21) * sky;
    vec3 tint = vec3(0.46, 0.49, 0.55);
    result = vec4(sqrt(tint * tint * light), 1.0);
}
