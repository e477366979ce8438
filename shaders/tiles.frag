// Of each tile of the picture the farthest depth that any of its pixels shows.
#if SAMPLES > 1
layout(binding = 0) uniform sampler2DMS depths;
float farthest(ivec2 at) {
    float depth = 0.0;
    for (int s = 0; s < SAMPLES; ++s) depth = max(depth, texelFetch(depths, at, s).r);
    return depth;
}
#else
layout(binding = 0) uniform sampler2D depths;
float farthest(ivec2 at) { return texelFetch(depths, at, 0).r; }
#endif
layout(location = 0) out float result;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * tileSize, last = min(first + tileSize, ivec2(frame.picture.xy)) - 1;
    float depth = 0.0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) depth = max(depth, farthest(ivec2(x, y)));
    result = depth;
}
