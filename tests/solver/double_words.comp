#version 460
// For tests: SPIR-V 1.0 is made of it.
layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Words { uint words[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Answers { uint answers[]; };

layout(push_constant, std430) uniform Push { uint words_per_thread; };

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    answers[i * words_per_thread] = 2 * words[i];
}
