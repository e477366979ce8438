// The values of one picture, shared by all shaders; its twin is FrameBlock in render/renderer.cpp.
layout(std140, binding = 0) uniform Frame {
    mat4 view, projection, viewBefore;   // viewBefore: of the picture before
    // Of the picture; right and up reach its edges at distance 1. Like the domain's size they are
    // given where y is up and the ground's corner is 0, whatever is up in the world.
    vec4 eye, right, up, forward;
    vec4 sky;                       // the world's up in the camera's axes
    vec4 picture;                   // width, height, samples, line width in px
    vec4 domain;                    // size in m, step of the ground's grid (0 = no ground)
    vec4 particle;                  // radius in m, smallest in px, px a metre at distance 1, fluids
    vec4 color;                     // lowest value, 1 / span, row of the table; 1 = plain, 2 = plain in two dimensions
} frame;

const int tileSize = 8;   // px, see render/occlusion.h
