#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_int8 : require
// For tests: a workgroup of literal sizes, shared memory, and push constants that do not end at a word.
layout(local_size_x = 32, local_size_y = 32, local_size_z = 2) in;

layout(set = 0, binding = 0, std430) writeonly buffer Answers { uint answers[]; };

layout(push_constant, std430) uniform Push
{
    uint word;
    u8vec3 bytes;
};

shared uint words[2048];

void main()
{
    words[gl_LocalInvocationIndex] = word + uint(bytes.z);
    answers[gl_LocalInvocationIndex] = words[gl_LocalInvocationIndex];
}
