#version 460
// For tests: SPIR-V 1.6 names the constants of a workgroup's size in an execution mode.
layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) writeonly buffer Answers { uint answers[]; };

void main() { answers[gl_GlobalInvocationID.x] = 1; }
