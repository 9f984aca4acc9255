// Floats as whole numbers of the same order, for atomicMin and atomicMax.
#ifndef VOILE_ORDERED_GLSL
#define VOILE_ORDERED_GLSL

uint ordered(float x)
{
    const uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

float from_ordered(uint x) { return uintBitsToFloat((x & 0x80000000u) != 0 ? x & 0x7fffffffu : ~x); }

#endif
