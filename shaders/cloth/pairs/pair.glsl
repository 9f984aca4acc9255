// A pair of primitives that share no vertex, in four words, and how near they are.
#ifndef VOILE_PAIR_GLSL
#define VOILE_PAIR_GLSL

#include "shared/separation.glsl"

const uint k_pair_edges_bit = 1u << 31; // of the first word

// The vertices of two edges: each edge's in ascending order, first the edge with the lowest of all. Of a vertex and a
// triangle: the vertex, then the triangle's in ascending order. Both sides of a pair pack the same words.
struct Pair
{
    uvec4 vertices;
    bool edges;
};

uvec4 ordered_edges(uvec2 a, uvec2 b)
{
    a = uvec2(min(a.x, a.y), max(a.x, a.y));
    b = uvec2(min(b.x, b.y), max(b.x, b.y));
    return a.x < b.x ? uvec4(a, b) : uvec4(b, a); // they share no vertex
}

uvec4 ordered_triangle(uint vertex, uvec3 t)
{
    const uint low = min(t.x, min(t.y, t.z));
    const uint high = max(t.x, max(t.y, t.z));
    return uvec4(vertex, low, t.x ^ t.y ^ t.z ^ low ^ high, high);
}

uvec4 packed(Pair pair) { return uvec4(pair.vertices.x | (pair.edges ? k_pair_edges_bit : 0), pair.vertices.yzw); }

Pair unpacked(uvec4 words)
{
    return Pair(uvec4(words.x & ~k_pair_edges_bit, words.yzw), (words.x & k_pair_edges_bit) != 0);
}

// The number of vertices of the first side.
uint first_side(Pair pair) { return pair.edges ? 2 : 1; }

// The place of a vertex in a pair, 0 to 3; 4: it is not in it.
uint place_in(Pair pair, uint vertex)
{
    const bvec4 equal = equal(pair.vertices, uvec4(vertex));
    return equal.x ? 0 : equal.y ? 1 : equal.z ? 2 : equal.w ? 3 : 4;
}

// An entry of a vector by a place that is not constant. An index would put the vector into memory.
float entry_of(vec4 v, uint place) { return place == 0 ? v.x : place == 1 ? v.y : place == 2 ? v.z : v.w; }

// The owners of both sides.
uvec2 owners_of(Pair pair) { return pair.edges ? pair.vertices.xz : pair.vertices.xy; }

#endif
