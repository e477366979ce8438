// The surface of the fluid over what is behind it: what it mirrors, what it bends and swallows.
layout(binding = 0) uniform sampler2D surface;     // as normals.frag has it
layout(binding = 1) uniform sampler2D thicknesses; // m
layout(binding = 2) uniform sampler2D tints;       // times their weights, their weights
layout(binding = 3) uniform sampler2D behind;
layout(location = 0) out vec4 result;

// Of four neighbours the mean normal and distance, and how much of them is fluid. Of an edge within
// the fluid the nearer side.
struct Seen {
    vec3 normal;
    float distance, inside, fluid;
};
Seen surfaceAt(vec2 at) {
    vec2 texel = at * vec2(textureSize(surface, 0)) - 0.5, share = fract(texel);
    ivec2 first = ivec2(floor(texel));
    vec4 s[4];
    float nearest = 1e30;
    for (int k = 0; k < 4; ++k) {
        ivec2 texel = clamp(first + ivec2(k % 2, k / 2), ivec2(0), textureSize(surface, 0) - 1);
        s[k] = texelFetch(surface, texel, 0);
        if (s[k].w > 0.0) nearest = min(nearest, s[k].w);
    }
    Seen seen = Seen(vec3(0.0), 0.0, 0.0, 0.0);
    float all = 0.0;
    for (int k = 0; k < 4; ++k) {
        vec2 near = mix(1.0 - share, share, vec2(k % 2, k / 2));
        float weight = near.x * near.y;
        if (s[k].w <= 0.0) continue;
        seen.fluid += weight;
        if (s[k].w > nearest + 4.0 * frame.particle.x) continue;
        seen.normal += weight * vec3(s[k].xy, sqrt(max(1.0 - dot(s[k].xy, s[k].xy), 0.0)));
        seen.distance += weight * s[k].w, seen.inside += weight * s[k].z, all += weight;
    }
    if (all > 0.0) seen.distance /= all, seen.inside /= all;
    return seen;
}

const vec3 lampAt = vec3(-0.448, 0.647, 0.617);   // the key light of particles.frag

// A studio: dark below, lighter above, a broad lamp above the left shoulder.
vec3 mirrored(vec3 direction) {
    float up = dot(direction, frame.sky.xyz), lamp = max(dot(direction, lampAt), 0.0);
    vec3 room = mix(vec3(0.03, 0.04, 0.06), vec3(0.62, 0.72, 0.85), smoothstep(-0.3, 1.0, up));
    return room + vec3(0.9, 0.88, 0.84) * smoothstep(0.75, 0.99, lamp);
}

// Where fluid is torn to drops there is air in it. At the outline of more of it, it's thin on one
// side only.
float torn(vec2 at, float distance) {
    vec2 apart = 8.0 * frame.particle.x * frame.particle.z / divisor(distance) / frame.picture.xy;
    float most = 0.0;
    for (int k = 0; k < 4; ++k)
        most = max(most, texture(thicknesses, at + vec2(2 * (k % 2) - 1, k - k % 2 - 1) * apart).r);
    return 1.0 - smoothstep(1.0, 4.0, 0.5 * most / frame.particle.x);
}

void main() {
    vec2 at = gl_FragCoord.xy / frame.picture.xy, texel = 1.0 / vec2(textureSize(surface, 0));
    Seen seen = surfaceAt(at);
    if (seen.fluid < 0.25) discard;
    float distance = seen.distance, cover = clamp(2.0 * seen.fluid - 0.5, 0.0, 1.0);
    vec3 here = placeAt(at, distance), normal = normalize(seen.normal);
    vec3 toEye = isOrthographic() ? vec3(0.0, 0.0, 1.0) : normalize(-here);
    float facing = clamp(dot(normal, toEye), 0.0, 1.0);
    // At the outline, where there is no neighbour to tell the slope, it mirrors less.
    float edge = smoothstep(0.5, 1.0, seen.inside) * smoothstep(0.0, 0.2, facing);
    float fresnel = 0.03 + edge * min(0.97 * pow(1.0 - facing, 5.0), 0.6);
    float thickness = texture(thicknesses, at).r;

    // Bent by as much as the fluid is thick there.
    float bend = min(0.35 * thickness * frame.particle.z / divisor(distance), 0.06 * frame.picture.y);
    vec2 through = clamp(at - normal.xy * bend / frame.picture.xy, texel, 1.0 - texel);
    vec3 back = texture(behind, through).rgb;
    back *= back;
    float size = max(frame.domain.x, max(frame.domain.y, frame.domain.z));
    // A tenth of the domain's size of water is blue, more is deeply so.
    vec3 passes = exp(-vec3(12.0, 5.0, 2.6) * thickness / size);
    float above = dot(normal, frame.sky.xyz), key = max(dot(normal, lampAt), 0.0);
    vec3 scattered = vec3(0.03, 0.24, 0.58) * (0.60 + 0.35 * key + 0.25 * above);
    vec3 water = back * passes + scattered * (1.0 - passes);
    float foam = frame.color.w > 1.0 ? 0.0 : 0.5 * torn(at, distance);
    water = mix(water, vec3(0.62, 0.70, 0.76) * (0.55 + 0.45 * key), foam);
    if (frame.color.w == 0.0) {
        vec4 tint = texture(tints, at);
        vec3 color = tint.rgb / max(tint.a, 1e-6);
        vec3 light = vec3(0.40, 0.42, 0.46) + vec3(0.80, 0.78, 0.74) * key +
                     vec3(0.16, 0.18, 0.21) * above;
        float opaque = 1.0 - 0.35 * exp(-0.25 * thickness / frame.particle.x);
        water = mix(back, color * light, opaque);
        fresnel *= 0.6;
    }
    vec3 shade = mix(water, mirrored(reflect(-toEye, normal)), fresnel);
    vec3 middle = normalize(lampAt + toEye);
    shade += 0.5 * edge * pow(max(dot(normal, middle), 0.0), 160.0);
    result = vec4(sqrt(clamp(shade, 0.0, 1.0)), cover);
    gl_FragDepth = 0.5 * clipDepth(distance) + 0.5;
}
