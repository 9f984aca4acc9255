#version 460
// Does nothing, with as many push constants as the contact pass has, to measure what recording a dispatch costs.
// Reads and writes nothing.
layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0) readonly buffer Unused { uint unused[]; };

layout(push_constant, std430) uniform Push { vec4 constants[7]; } push;

void main() {}
