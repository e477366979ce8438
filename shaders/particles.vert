// A particle becomes a square that just holds its sphere.
layout(location = 0) in vec4 vertex;   // position, value
layout(binding = 0) uniform sampler2D tables;
layout(binding = 1) uniform sampler2D tilesBefore;
layout(binding = 2) uniform sampler2D tilesNow;
// Draws those that the first call, with tilesBefore, left out wrongly.
layout(location = 0) uniform bool second;

layout(location = 0) flat out vec4 tint;    // linear colour, opacity
layout(location = 1) flat out vec3 shape;   // square / sphere, its radius in px and in depth

float pixelsOf(float radius, vec4 place) {
    return max(radius * frame.particle.z / max(divisor(-place.z), 1e-6), frame.particle.y);
}

// In clip space, of the sphere's nearest point.
float nearestDepth(float radius, vec4 place) {
    vec4 front = frame.projection * vec4(place.xy, min(place.z + radius, -1e-6), 1.0);
    return front.z / front.w;
}

// Whether all of a sphere lies behind what the tiles say, those within `reach` (px) of its middle.
bool isHidden(sampler2D tiles, vec4 place, float radius, float reach) {
    float nearest = nearestDepth(radius, place), depth = 0.5 * nearest + 0.5 - 1e-6;
    // Near and large: hardly ever hidden.
    if (!(nearest > -1.0) || reach > 3.0 * float(tileSize)) return false;
    vec4 clip = frame.projection * place;
    vec2 middle = (0.5 * clip.xy / clip.w + 0.5) * frame.picture.xy;
    ivec2 last = textureSize(tiles, 0) - 1;
    ivec2 low = clamp(ivec2(floor((middle - reach) / float(tileSize))), ivec2(0), last);
    ivec2 high = clamp(ivec2(floor((middle + reach) / float(tileSize))), ivec2(0), last);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
            if (texelFetch(tiles, ivec2(x, y), 0).r > depth) return false;
    return true;
}

// Whether this call leaves the sphere to the other one, or to none. What the picture before says of
// the middle is a guess, right or wrong; what this one says is exact.
bool isLeftOut(vec4 place, float radius) {
    bool guess = isHidden(tilesBefore, frame.viewBefore * vec4(vertex.xyz, 1.0), radius, 0.0);
    if (!second) return guess;
    return !guess || isHidden(tilesNow, place, radius, pixelsOf(radius, place) + 1.5);
}

void main() {
    bool wall = gl_VertexID >= int(frame.particle.w);
    vec4 place = frame.view * vec4(vertex.xyz, 1.0);
    bool solid = wall && vertex.w > 0.5, elastic = wall && vertex.w > 1.5;
    float radius = frame.particle.x * (elastic ? vertex.w - 2.0 : wall && !solid ? 0.4 : 1.0);
    bool shown = wall ? frame.clipLow.w < 0.5 || isInside(vertex.xyz)
                      : isShown(vertex.xyz, vertex.w);
    if (!shown || isLeftOut(place, radius)) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    float pixels = pixelsOf(radius, place);

    vec3 color = frame.color.w > 0.0 ? vec3(0.25, 0.56, 0.90) : tableColor(tables, vertex.w);
    if (wall) color = elastic ? vec3(0.78, 0.45, 0.36) : vec3(0.46, 0.49, 0.55);
    tint = vec4(color * color, elastic ? 0.45 : wall && !solid ? 0.4 : 1.0);

    gl_Position = frame.projection * place;
    // The square's depth is the sphere's nearest point; the fragment goes back from there.
    float depth = gl_Position.z / gl_Position.w, nearest = nearestDepth(radius, place);
    shape = vec3((pixels + 0.5) / pixels, pixels, 0.5 * (depth - nearest));
    if (nearest > -1.0) gl_Position.z = nearest * gl_Position.w;
    else shape.z = 0.0;
    gl_PointSize = 2.0 * pixels + 1.0;
}
