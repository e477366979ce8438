// A studio, dark or light: a gradient, and a ground whose grid fades out.
layout(location = 0) in vec3 ray;
layout(location = 1) in float height;
layout(location = 0) out vec4 result;

// Share of a line 1 px wide in this pixel, for lines at whole numbers of `at`.
float line(vec2 at, vec2 pixel) {
    vec2 away = abs(fract(at - 0.5) - 0.5) / pixel;
    vec2 cover = clamp(frame.picture.w * 0.5 + 0.5 - away, 0.0, 1.0) * clamp(0.5 / pixel, 0.0, 1.0);
    return max(cover.x, cover.y);
}

void main() {
    bool light = frame.look.x > 0.5;
    vec3 shade = light ? mix(vec3(0.880, 0.895, 0.915), vec3(0.970, 0.975, 0.985), height)
                       : mix(vec3(0.150, 0.168, 0.205), vec3(0.070, 0.079, 0.102), height);
    vec3 from = frame.eye.xyz;
    if (isOrthographic()) {
        vec2 corner = 2.0 * gl_FragCoord.xy / frame.picture.xy - 1.0;
        from += corner.x * frame.right.xyz + corner.y * frame.up.xyz;
    }
    float down = -ray.y, top = from.y + frame.particle.x;
    if (frame.domain.w > 0.0 && down > 0.0 && top > 0.0) {
        vec3 hit = from + ray * (top / down);
        vec2 middle = 0.5 * frame.domain.xz, reach = abs(hit.xz - middle);
        float size = max(frame.domain.x, frame.domain.z);
        float fade = exp(-0.45 * dot(hit.xz - middle, hit.xz - middle) / (size * size));
        // The tank's soft shadow.
        vec2 outside = max(reach - middle, 0.0);
        float shadow = 1.0 - smoothstep(0.0, 0.28 * size, length(outside));
        vec2 at = hit.xz / frame.domain.w;
        // How far one pixel reaches on the ground.
        vec2 pixel = max(fwidth(at), 1e-6);
        float grid = 0.060 * line(at, pixel) + 0.055 * line(0.2 * at, 0.2 * pixel);
        shade += light ? -fade * vec3(0.02 + 1.6 * grid)
                       : fade * (vec3(0.050, 0.056, 0.066) + grid);
        shade *= 1.0 - (light ? 0.12 : 0.45) * fade * shadow;
    }
    // Noise of half a step keeps the gradient free of bands.
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    result = vec4(shade + (noise - 0.5) / 255.0, 1.0);
}
