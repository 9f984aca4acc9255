// Which primitives that two vertices own are near each other: those of the vertex that searches, and of a candidate.
//
// The including kernel declares cloths[], mesh_fans[], mesh_wedges[], midpoints[], pair_carries[] and defines
// insert() and goes_on().
#ifndef VOILE_SEARCH_GLSL
#define VOILE_SEARCH_GLSL

#include "contact/rounding.glsl"
#include "shared/box.glsl"
#include "pairs/node.glsl"
#include "pairs/pair.glsl"
#include "pairs/wedges.glsl"

// A wedge with its vertices, as the search sees them. A spoke that the fan does not own repeats the center.
struct Piece
{
    Node a; // the center
    Node b;
    Node c;
    Wedge wedge;
    Box box;
};

// Around the primitives of a piece with their sweeps: the middle and the radius.
struct Spheres
{
    vec4 edge_b;
    vec4 edge_c;
    vec4 triangle;
};

// The search of a vertex.
struct Search
{
    Fan fan;
    Viewpoint from; // the middle of the vertex's sweep, carried as the vertex is
    float range;
    float rounding; // m, of positions near it
    uint count; // of pairs
    uint lane;
    uint lanes;
    uint candidate;   // the place of the one that is searched
    uint combination; // of its wedges with those of the vertex
    uint own_wedge; // its piece is in `own`
    Piece own;
};

// Rounding of spheres, as a part of their radii.
const float k_sphere_rounding = 1e-5;

Box around(Node node) { return Box(node.x - extent_of(node), node.x + extent_of(node)); }

// m: how far the vertex may be from its middle.
float reach_of(Node node) { return length(node.sweep) + length(node.carry) + node.fall; }

Piece piece_of(Search search, Fan fan, uint k)
{
    Piece piece;
    piece.wedge = wedge_of(fan, k);
    piece.a = node_of(fan.center, search.from);
    piece.b = piece.wedge.triangle || piece.wedge.edge_b ? node_of(piece.wedge.b, search.from) : piece.a;
    piece.c = piece.wedge.triangle || piece.wedge.edge_c ? node_of(piece.wedge.c, search.from) : piece.a;
    piece.box = joined(around(piece.a), joined(around(piece.b), around(piece.c)));
    return piece;
}

Spheres spheres_of(Piece piece)
{
    const vec3 a = piece.a.x;
    const vec3 b = piece.b.x;
    const vec3 c = piece.c.x;
    const vec3 reaches = vec3(reach_of(piece.a), reach_of(piece.b), reach_of(piece.c));
    const vec3 middle = (a + b + c) / 3;
    const vec3 radii = vec3(distance(middle, a), distance(middle, b), distance(middle, c));
    Spheres spheres;
    spheres.edge_b = vec4(0.5 * (a + b), 0.5 * distance(a, b) + max(reaches.x, reaches.y));
    spheres.edge_c = vec4(0.5 * (a + c), 0.5 * distance(a, c) + max(reaches.x, reaches.z));
    spheres.triangle = vec4(middle, max(radii.x, max(radii.y, radii.z)) + max(reaches.x, max(reaches.y, reaches.z)));
    return spheres;
}

// Which primitives of two wedges are a pair: the vertex and the triangle of the candidate, the reverse, or two edges: from
// here on two bits say which, as in nodes_of.
const uint k_own_vertex = 0;
const uint k_own_triangle = 1;
const uint k_edges = 4;

// The kernel's: what it does with a pair within the range, and whether it looks for more.
void insert(inout Search search, uint kind, uvec4 vertices, bool edges, float at);
bool goes_on(Search search);

// m: between both sides along a direction, `heights` and `sweeps`: of the vertices along it.
float gap_between(bool edges, vec4 heights, vec4 sweeps)
{
    const vec4 low = heights - sweeps;
    const vec4 high = heights + sweeps;
    return (edges ? min(low.x, low.y) : low.x) - (edges ? max(high.z, high.w) : max(high.y, max(high.z, high.w)));
}

// m: a lower bound of the distance of both sides along their sweeps. Both are convex, so any direction gives one. This
// one is that of the nearest points of the middles. A sweep across it costs nothing, nor does what carries both. The
// gap is concave in the time of the clock, so that it is least at one end.
float distance_of(Search search, bool edges, Node nodes[4])
{
    const vec3 x[4] = vec3[](nodes[0].x, nodes[1].x, nodes[2].x, nodes[3].x);
    const vec3 apart = nearest_points(edges, x).apart;
    const vec3 n = apart / max(length(apart), 1e-20);
    vec4 heights;
    vec4 sweeps;
    vec4 carries;
    [[unroll]] for (uint k = 0; k < 4; ++k)
    {
        heights[k] = dot(n, x[k] - x[0]);
        sweeps[k] = abs(dot(n, nodes[k].sweep)) + nodes[k].fall;
        carries[k] = dot(n, nodes[k].carry);
    }
    return min(gap_between(edges, heights - carries, sweeps), gap_between(edges, heights + carries, sweeps)) -
           search.rounding;
}

// False: the distance is more than the range.
bool are_near(Search search, vec4 a, vec4 b)
{
    const vec3 apart = a.xyz - b.xyz;
    const float near = (a.w + b.w) * (1 + k_sphere_rounding) + search.range + search.rounding;
    return dot(apart, apart) <= near * near;
}

bool has_vertex(Piece piece, uint vertex)
{
    return vertex == piece.a.vertex || vertex == piece.b.vertex || vertex == piece.c.vertex;
}

bool is_triangle_near(Search search, Node v, Piece piece, vec4 around)
{
    return piece.wedge.triangle && are_near(search, vec4(v.x, reach_of(v)), around) && !has_vertex(piece, v.vertex);
}

// The kinds of pairs of two wedges that may be within the range, a bit each.
uint near_kinds(Search search, Piece own, Piece piece, bool own_vertex, bool own_triangle)
{
    const Spheres of_own = spheres_of(own);
    const Spheres of_other = spheres_of(piece);
    uint kinds = 0;
    if (own_vertex && is_triangle_near(search, own.a, piece, of_other.triangle))
        kinds |= 1u << k_own_vertex;
    if (own_triangle && is_triangle_near(search, piece.a, own, of_own.triangle))
        kinds |= 1u << k_own_triangle;
    [[unroll]] for (uint k = 0; k < 4; ++k)
    {
        const bool first = (k & 1u) == 0;
        const bool second = (k & 2u) == 0;
        const uint b = first ? own.b.vertex : own.c.vertex;
        const uint d = second ? piece.b.vertex : piece.c.vertex;
        if ((first ? own.wedge.edge_b : own.wedge.edge_c) && (second ? piece.wedge.edge_b : piece.wedge.edge_c) &&
            are_near(search, first ? of_own.edge_b : of_own.edge_c, second ? of_other.edge_b : of_other.edge_c) &&
            own.a.vertex != piece.a.vertex && own.a.vertex != d && b != piece.a.vertex && b != d)
            kinds |= 1u << (k_edges + k);
    }
    return kinds;
}

// The vertices of a pair: those of the first side, then those of the second.
Node[4] nodes_of(uint kind, Piece own, Piece piece)
{
    if (kind == k_own_vertex)
        return Node[](own.a, piece.a, piece.b, piece.c);
    if (kind == k_own_triangle)
        return Node[](piece.a, own.a, own.b, own.c);
    Node b = own.c;
    if ((kind & 1u) == 0)
        b = own.b;
    Node d = piece.c;
    if ((kind & 2u) == 0)
        d = piece.b;
    return Node[](own.a, b, piece.a, d);
}

uvec4 ordered_vertices(bool edges, Node nodes[4])
{
    return edges ? ordered_edges(uvec2(nodes[0].vertex, nodes[1].vertex), uvec2(nodes[2].vertex, nodes[3].vertex))
                 : ordered_triangle(nodes[0].vertex, uvec3(nodes[1].vertex, nodes[2].vertex, nodes[3].vertex));
}

// One loop over what is near, not a branch for each kind: llvmpipe executes both sides of branches.
void consider_pieces(inout Search search, Piece own, Piece piece, uint kinds)
{
    for (; kinds != 0 && goes_on(search); kinds &= kinds - 1)
    {
        const uint kind = uint(findLSB(kinds));
        const bool edges = kind >= k_edges;
        const Node nodes[4] = nodes_of(kind, own, piece);
        const float at = distance_of(search, edges, nodes);
        if (at <= search.range)
            insert(search, kind, ordered_vertices(edges, nodes), edges, at);
    }
}

// Wedges of both fans are tested in pairs, each by one thread of the search.
void consider_fan(inout Search search, Fan fan)
{
    const uint own_wedges = search.fan.wedges;
    uint wedge = fan.wedges; // of `piece`
    Piece piece;
    // A thread has room for few pairs, so in the next candidate of a mesh another one takes the same wedges. Those of grids
    // have one combination each, and keep their own wedge.
    const uint first = fan.columns > 0 ? search.lane : (search.lane + search.candidate) % search.lanes;
    for (uint k = first; k < own_wedges * fan.wedges && goes_on(search); k += search.lanes)
    {
        const uint j = k % own_wedges;
        if (wedge != k / own_wedges)
            piece = piece_of(search, fan, k / own_wedges);
        wedge = k / own_wedges;
        if (search.own_wedge != j)
            search.own = piece_of(search, search.fan, j);
        search.own_wedge = j;
        if (!overlap(grown(piece.box, search.range + search.rounding), search.own.box))
            continue;
        search.combination = k;
        consider_pieces(search, search.own, piece, near_kinds(search, search.own, piece, j == 0, k < own_wedges));
    }
}

// One of `lanes` threads of the search of a vertex.
Search search_of(uint vertex, PairList list, uint lane, uint lanes)
{
    Search search;
    search.fan = fan_of(list.cloth, vertex);
    search.from = viewpoint_of(vertex);
    search.range = list.range;
    search.rounding = 4 * rounding(search.from.x);
    search.count = 0;
    search.lane = lane;
    search.lanes = lanes;
    search.own_wedge = search.fan.wedges;
    search.candidate = search.combination = 0;
    return search;
}

#endif
