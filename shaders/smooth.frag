// The narrow-range filter (Truong and Yuksel 2018), along one direction: a mean of distances that
// leaves out what is far behind or in front, so that neither edges nor waves in front of each other
// wash out; how far that is grows with the slope of what is not.
layout(binding = 0) uniform sampler2D distances;   // m; 0: no fluid
layout(location = 0) uniform ivec2 along;
// Of the filter, in particle radii; px of this pass / px of the picture.
layout(location = 1) uniform vec2 reach;
layout(location = 0) out float result;

const int most = 10;   // pairs of neighbours

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    float own = texelFetch(distances, here, 0).r;
    result = own;
    if (own <= 0.0) return;
    float radius = frame.particle.x, pixels = reach.x * radius * frame.particle.z * reach.y / divisor(own);
    int pairs = clamp(int(pixels + 0.5), 1, most);
    float stride = max(pixels / float(pairs), 1.0);
    float behind = 4.0 * radius, before = behind;   // how far neighbours may be
    float sum = own, weights = 1.0;
    ivec2 last = textureSize(distances, 0) - 1;
    for (int k = 1; k <= pairs; ++k) {
        ivec2 away = ivec2(round(float(k) * stride)) * along;
        float a = texelFetch(distances, min(here + away, last), 0).r,
              b = texelFetch(distances, max(here - away, ivec2(0)), 0).r;
        // Without its partner a neighbour would tilt the surface.
        if (a <= 0.0 || b <= 0.0 || max(a, b) > own + behind || min(a, b) < own - before) continue;
        float x = float(k) / float(pairs), weight = exp(-2.0 * x * x);
        behind = max(behind, max(a, b) - own + 4.0 * radius);
        before = max(before, own - min(a, b) + 4.0 * radius);
        sum += weight * (a + b);
        weights += 2.0 * weight;
    }
    result = sum / weights;
}
