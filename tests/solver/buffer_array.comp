#version 460
// For tests: an array of buffers, which kernels do not take.
layout(local_size_x = 64) in;

layout(set = 0, binding = 3, std430) writeonly buffer Answers { uint answers[]; } buffers[2];

void main() { buffers[1].answers[gl_GlobalInvocationID.x] = 1; }
