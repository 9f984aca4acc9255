// The neighbors that decide how far a vertex is carried: all that are clear of colliders, or some.
#ifndef VOILE_NEIGHBORHOOD_GLSL
#define VOILE_NEIGHBORHOOD_GLSL

// Of a grid: the columns and the rows, from the vertex.
const int k_neighborhood[4] = int[](-5, -2, 2, 5);
// In edges of the cloth.
const float k_neighborhood_radius = 7.1;

#endif
