layout(location = 0) in vec2 at;
layout(location = 1) in vec4 tint;
layout(location = 0) out vec4 result;
layout(binding = 0) uniform sampler2D atlas;

void main() { result = vec4(tint.rgb, tint.a * texture(atlas, at).r); }
