// A walk over the colliders that may touch a vertex, in their order: those listed for its patch
// (find_near_colliders.comp), or all.
//
// A list is valid inside the patch's box. A vertex outside of that walks over all colliders, so that none is missed.
// The results are equal to the bit, because a collider that is not near changes nothing.
//
// The including kernel declares near_colliders[], push.colliders and push.near_stride. VOILE_NEAR_LISTS may be defined
// as false: there are no lists.
#ifndef VOILE_NEAR_COLLIDERS_GLSL
#define VOILE_NEAR_COLLIDERS_GLSL

#include "shared/box.glsl"

#ifndef VOILE_NEAR_LISTS
#define VOILE_NEAR_LISTS true
#endif

const uint k_all_colliders = 0xffffffffu;

struct ColliderWalk
{
    uint patch_index;
    uint first; // first word of the patch's bits, or k_all_colliders
    uint next;  // word of the bits; without lists: the next collider
    uint end;
    uint bits;  // the rest of the word before `next`
};

vec3 near_corner(uint word)
{
    return vec3(uintBitsToFloat(near_colliders[word]), uintBitsToFloat(near_colliders[word + 1]),
                uintBitsToFloat(near_colliders[word + 2]));
}

// Whether the list of a patch is valid in the box.
bool has_near_list(uint patch_index, Box box)
{
    if (!VOILE_NEAR_LISTS || push.near_stride == 0)
        return false;
    const uint header = patch_index * push.near_stride;
    return all(greaterThanEqual(box.min, near_corner(header + VOILE_NEAR_MIN))) &&
           all(lessThanEqual(box.max, near_corner(header + VOILE_NEAR_MAX)));
}

uint collider_bits(uint first, uint word)
{
    if (first != k_all_colliders)
        return near_colliders[first + word];
    const uint left = push.colliders - 32 * word;
    return left < 32 ? (1u << left) - 1 : 0xffffffffu;
}

ColliderWalk walk_all(uint patch_index)
{
    return ColliderWalk(patch_index, k_all_colliders, 0, (push.colliders + 31) / 32, 0);
}

// Over the colliders that may touch the box.
ColliderWalk walk_colliders(uint patch_index, Box box)
{
    if (!has_near_list(patch_index, box))
        return walk_all(patch_index);
    const uint header = patch_index * push.near_stride;
    return ColliderWalk(patch_index, header + VOILE_NEAR_WORDS, near_colliders[header + VOILE_NEAR_FIRST],
                        near_colliders[header + VOILE_NEAR_END], 0);
}

bool next_collider(inout ColliderWalk walk, out uint c)
{
    if (!VOILE_NEAR_LISTS)
    {
        c = walk.next++;
        return c < push.colliders;
    }
    c = 0;
    while (walk.bits == 0)
    {
        if (walk.next >= walk.end)
            return false;
        walk.bits = collider_bits(walk.first, walk.next++);
    }
    c = 32 * (walk.next - 1) + uint(findLSB(walk.bits));
    walk.bits &= walk.bits - 1;
    return true;
}

// After collider c has moved the vertex to x: continues over all following colliders if x is outside of the list's box.
void continue_walk(inout ColliderWalk walk, uint c, vec3 x)
{
    if (walk.first == k_all_colliders || has_near_list(walk.patch_index, Box(x, x)))
        return;
    walk = ColliderWalk(walk.patch_index, k_all_colliders, c / 32 + 1, (push.colliders + 31) / 32,
                        collider_bits(k_all_colliders, c / 32) & ~((2u << (c % 32)) - 1));
}

#endif
