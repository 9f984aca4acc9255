// Islands (PairIsland): cloths that may come near each other.
//
// The including kernel declares pair_islands[].
#ifndef VOILE_ISLAND_GLSL
#define VOILE_ISLAND_GLSL

// The island of a cloth: its first cloth.
uint island_of(uint cloth) { return cloth - pair_islands[cloth].before; }

#endif
