// Places in the lists that kernels of pairs append to. A workgroup reserves its places in a list at once.
//
// The including kernel declares pair_passes[].
#ifndef VOILE_RESERVATION_GLSL
#define VOILE_RESERVATION_GLSL

// The number of entries that the workgroup appends to a pass, then, once a thread has reserved them, the first.
// `threads`: that take one entry.
void reserve(inout uint entries, uint pass, uint threads)
{
    if (entries == 0)
        return;
    const uint count = entries;
    entries = atomicAdd(pair_passes[pass].entries, count);
    atomicMax(pair_passes[pass].groups, ((entries + count) * threads + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x);
}

#endif
