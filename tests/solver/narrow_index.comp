#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_int16 : require
// For tests: an index that does not have 32 bits.
layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std430) readonly buffer Words { uint words[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Answers { uint answers[]; };

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    answers[i] = words[uint16_t(i)];
}
