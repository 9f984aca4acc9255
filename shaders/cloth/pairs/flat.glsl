// Neighborhoods of a grid's vertex in which only primitives that share a vertex are near each other: a window of
// vertices, a rectangle in rows and columns.
//
// Why. Let h and v be the edges along rows and columns, as they are between the middles of sweeps, projected onto any
// plane. From a point of the window to another one, a columns and b rows away, the projected surface leads by a h' + b v'
// with means h' and v' of the edges on the straight line between them in the grid, which the window contains. The means
// are in the convex hulls of the edges: within discs around h0 and v0 with the radii rh and rv.
//
// The hat functions of a primitive's vertices sum to 1 on it, and to 0 on any primitive without these vertices. Cells are
// cut from the right to the lower vertex, so the gradient of a sum of hat functions is one of (1, 0), (0, 1), (1, 1) and
// their opposites, or 0. So between two primitives that share no vertex max(|a|, |b|, |a + b|) >= 1: (a, b) is outside of
// a hexagon or on it. |a h' + b v'| is homogeneous, so its least value is on the hexagon, whose sides are the segments
// from h to v, from h - v to h, from v - h to v, and their opposites. On the first a + b = 1 and a, b >= 0, so discs
// matter by the larger radius. On the others |a|, |b| <= 1, so they matter by the sum of both radii.
//
// The clock carries vertices together. At any time the edges are between those at its beginning and at its end, so both
// count. From there a vertex may be anywhere on its sweep, so each side comes nearer by at most half of the longest
// sweep, projected. Projections are not longer than what they project. tests/pairs/test_pair_lists.cpp compares with all pairs.
//
// The including kernel declares midpoints[], pair_carries[] and push.
#ifndef VOILE_FLAT_GLSL
#define VOILE_FLAT_GLSL

#include "pairs/fan.glsl"
#include "pairs/node.glsl"

// The primitives of two vertices are within a window around one of them, if the other is so many columns and rows away.
const ivec2 k_flat_offset = ivec2(3, 2);
const ivec2 k_flatter_offset = ivec2(1, 1);

// m: of the windows for both offsets, the least distance between primitives that share no vertex; <= 0: unknown.
struct Flat
{
    float wide;
    float narrow;
};

// The least and the greatest of several vectors.
struct Spread
{
    vec2 low;
    vec2 high;
};

Spread no_spread() { return Spread(vec2(1e30), vec2(-1e30)); }

void add(inout Spread spread, vec2 value)
{
    spread.low = min(spread.low, value);
    spread.high = max(spread.high, value);
}

struct Window
{
    Spread along; // m, edges along rows, in the plane
    Spread down;  // along columns
    float sweep;  // m, half of the longest one in the plane
};

// m, of the segment from a to b from the origin
float distance_of_segment(vec2 a, vec2 b)
{
    const vec2 d = b - a;
    return length(a + clamp(-dot(a, d) / max(dot(d, d), 1e-30), 0, 1) * d);
}

float least_distance(Window window)
{
    const vec2 h = 0.5 * (window.along.low + window.along.high);
    const vec2 v = 0.5 * (window.down.low + window.down.high);
    const float radius_h = 0.5 * distance(window.along.low, window.along.high);
    const float radius_v = 0.5 * distance(window.down.low, window.down.high);
    const float straight = min(distance_of_segment(h - v, h), distance_of_segment(v - h, v));
    const float least =
        min(distance_of_segment(h, v) - max(radius_h, radius_v), straight - radius_h - radius_v);
    return least - 2 * window.sweep;
}

// A plane and a point of it. Vectors in it have two coordinates.
struct Plane
{
    vec3 from;
    vec3 carry; // m, half of it
    float fall; // m, beyond that
    vec3 x;
    vec3 y;
};

vec2 in_plane(Plane plane, vec3 v) { return vec2(dot(plane.x, v), dot(plane.y, v)); }

// The plane of the edges around a vertex.
Plane tangent_plane(Fan fan)
{
    const ivec2 last = ivec2(fan.columns, fan.rows) - 1;
    const ivec2 low = max(fan.column_row - 1, ivec2(0)) - fan.column_row;
    const ivec2 high = min(fan.column_row + 1, last) - fan.column_row;
    const int center = int(fan.center);
    const int columns = int(fan.columns);
    const vec3 along = midpoints[center + high.x].xyz - midpoints[center + low.x].xyz;
    const vec3 down = midpoints[center + high.y * columns].xyz - midpoints[center + low.y * columns].xyz;
    const vec3 x = along / max(length(along), 1e-30);
    const vec3 y = down - dot(down, x) * x;
    return Plane(midpoints[center].xyz, unpack_half_sweep(pair_carries[center]), fall_of(pair_carries[center]), x,
                 y / max(length(y), 1e-30));
}

// Both windows of a vertex.
struct Windows
{
    Window wide;
    Window narrow;
};

// The columns of the wide window, to the left and to the right of its vertex.
const int k_flat_columns = k_flat_offset.x + 1;

// The vertices of a row of the wide window, in the plane.
struct Row
{
    bool exists;
    vec4 x[2 * k_flat_columns + 1]; // halfway, and half of its carry
};

// An edge at the beginning and at the end of the clock.
void add_edge(inout Spread spread, vec4 edge)
{
    add(spread, edge.xy - edge.zw);
    add(spread, edge.xy + edge.zw);
}

bool is_inner(ivec2 at)
{
    return all(lessThanEqual(-k_flatter_offset - ivec2(1, 0), at)) && all(lessThanEqual(at, k_flatter_offset + 1));
}

// Adds the vertices `row` rows away and their edges. `above`: the row before; becomes this row.
void add_row(Fan fan, Plane plane, int row, inout Row above, inout Windows windows)
{
    bool has_left = false;
    vec4 left = vec4(0);
    [[unroll]] for (int k = 0; k <= 2 * k_flat_columns; ++k)
    {
        const ivec2 at = ivec2(k - k_flat_columns, row);
        if (uint(fan.column_row.x + at.x) >= fan.columns)
            continue;
        const int vertex = int(fan.center) + at.y * int(fan.columns) + at.x;
        const vec4 midpoint = midpoints[vertex];
        const vec2 carry = in_plane(plane, unpack_half_sweep(pair_carries[vertex]) - plane.carry);
        const vec4 x = vec4(in_plane(plane, midpoint.xyz - plane.from), carry);
        const float fall = fall_between(fall_of(pair_carries[vertex]), plane.fall);
        const float sweep = length(in_plane(plane, unpack_half_sweep(floatBitsToUint(midpoint.w)))) + fall;
        const bool inner = is_inner(at);
        windows.wide.sweep = max(windows.wide.sweep, sweep);
        windows.narrow.sweep = inner ? max(windows.narrow.sweep, sweep) : windows.narrow.sweep;
        if (has_left)
            add_edge(windows.wide.along, x - left);
        if (has_left && inner && is_inner(at - ivec2(1, 0)))
            add_edge(windows.narrow.along, x - left);
        if (above.exists)
            add_edge(windows.wide.down, x - above.x[k]);
        if (above.exists && inner && is_inner(at - ivec2(0, 1)))
            add_edge(windows.narrow.down, x - above.x[k]);
        has_left = true;
        left = above.x[k] = x;
    }
    above.exists = true;
}

// `rounding`: m, of midpoints around the vertex.
Flat flatness(Fan fan, float rounding)
{
    const Plane plane = tangent_plane(fan);
    const Window nothing = Window(no_spread(), no_spread(), 0);
    Windows windows = Windows(nothing, nothing);
    Row above;
    above.exists = false;
    for (int row = -k_flat_offset.y; row <= k_flat_offset.y + 1; ++row)
        if (uint(fan.column_row.y + row) < fan.rows)
            add_row(fan, plane, row, above, windows);
    return Flat(least_distance(windows.wide) - rounding, least_distance(windows.narrow) - rounding);
}

bool within(ivec2 offset, ivec2 at) { return all(lessThanEqual(abs(at), offset)); }

// m: below which no primitives of a vertex and of another one `at` columns and rows away are, unless they share a vertex.
float flat_distance(Flat of, ivec2 at)
{
    return within(k_flatter_offset, at) ? max(of.wide, of.narrow) : within(k_flat_offset, at) ? of.wide : 0;
}

#endif
