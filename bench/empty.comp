#version 460
// Does nothing, to measure the cost of a dispatch. The binding exists because every kernel has a descriptor set bound.
// Reads and writes nothing.
layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0) readonly buffer Unused { uint unused[]; };

void main() {}
