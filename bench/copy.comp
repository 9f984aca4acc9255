#version 460
// Copies one vec4 per thread, neighbors side by side: the highest bandwidth a kernel can reach. Reads: source. Writes:
// destination.
layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Source { vec4 source[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Destination { vec4 destination[]; };

void main()
{
    destination[gl_GlobalInvocationID.x] = source[gl_GlobalInvocationID.x];
}
