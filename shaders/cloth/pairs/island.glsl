// Islands (PairIsland): cloths that may come near each other.
//
// The including kernel declares pair_islands[].
#ifndef VOILE_ISLAND_GLSL
#define VOILE_ISLAND_GLSL

// The island of a cloth: its first cloth.
uint island_of(uint cloth) { return cloth - pair_islands[cloth].before; }

// m/s: of its island, while lists are made and used.
vec3 frame_of(uint cloth)
{
    return vec3(pair_islands[cloth].frame[0], pair_islands[cloth].frame[1], pair_islands[cloth].frame[2]);
}

#endif
