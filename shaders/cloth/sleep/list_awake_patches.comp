#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the patches of each batch whose cloths are awake, in their order, and writes the size of the dispatches over
// them. One workgroup per batch.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/sleep_layout.h"
#include "shared/step_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(awake_dispatches)) writeonly buffer AwakeDispatches { AwakeDispatch awake_dispatches[]; };

layout(push_constant, std430) uniform Push { AwakePush push; };

shared uint shared_sum[gl_WorkGroupSize.x];

// Asks the cloth, because other threads write the words of patches meanwhile.
bool is_awake(uint patch_index) { return (cloths[patches[patch_index].cloth].flags & VOILE_CLOTH_ASLEEP) == 0; }

uint count_awake(uint first, uint end)
{
    uint count = 0;
    for (uint i = first; i < end; ++i)
        count += is_awake(i) ? 1 : 0;
    return count;
}

// The sum of the values of this thread and the threads before it.
uint inclusive_sum(uint value)
{
    const uint thread = gl_LocalInvocationID.x;
    shared_sum[thread] = value;
    barrier();
    for (uint stride = 1; stride < gl_WorkGroupSize.x; stride *= 2)
    {
        const uint before = thread >= stride ? shared_sum[thread - stride] : 0;
        barrier();
        shared_sum[thread] += before;
        barrier();
    }
    return shared_sum[thread];
}

void list_awake(uint first, uint end, uint slot)
{
    for (uint i = first; i < end; ++i)
        if (is_awake(i))
        {
            const uint bits = (1u << VOILE_PATCH_AWAKE_SHIFT) - 1;
            patches[slot].tile = (patches[slot].tile & bits) | i << VOILE_PATCH_AWAKE_SHIFT;
            ++slot;
        }
}

void main()
{
    const uint batch = gl_WorkGroupID.x;
    const uint begin = push.first_patch[batch];
    const uint end = push.first_patch[batch + 1];
    const uint per_thread = (end - begin + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x;
    const uint first = min(begin + gl_LocalInvocationID.x * per_thread, end);
    const uint last = min(first + per_thread, end);
    const uint count = count_awake(first, last);
    const uint sum = inclusive_sum(count);
    list_awake(first, last, begin + sum - count);
    if (gl_LocalInvocationID.x == gl_WorkGroupSize.x - 1)
        awake_dispatches[batch] = AwakeDispatch(sum, 1, 1);
}
