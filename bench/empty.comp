#version 460
// Nothing: what is left of a dispatch is its cost. The binding is there because every kernel has a set bound.
// Reads and writes nothing.
layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0) readonly buffer Unused { uint unused[]; };

void main() {}
