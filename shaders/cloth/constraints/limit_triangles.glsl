// The strain limit on the triangles of a fabric: F maps a unit vector d of the fabric to F d (membrane.glsl), which may
// not be longer than its limit along the warp, the weft and both diagonals. Edges in other directions than these are as
// long as that allows.
//
// The including kernel declares cloths[], positions[], step_positions[], mesh_vertices[], mesh_corners[],
// membrane_corners[] and end_at.
#ifndef VOILE_LIMIT_TRIANGLES_GLSL
#define VOILE_LIMIT_TRIANGLES_GLSL

// A triangle's corners, in the order of its gradients.
struct LimitTriangle
{
    uint corner[3];
    End end[3];
    vec2 gradient[3]; // 1/m, of the barycentric coordinates
    uint own;         // the number of the corner that is corrected
};

LimitTriangle limit_triangle(PatchVertex self, End own, uint entry)
{
    const MembraneCorner rest = membrane_corners[entry];
    const MeshCorner corner = mesh_corners[entry];
    const uint first = cloths[self.cloth].first_vertex;
    const uint others[2] = uint[](first + corner.b, first + corner.c);
    LimitTriangle t;
    t.own = rest.corner;
    t.gradient = vec2[](-(rest.gradient_1 + rest.gradient_2), rest.gradient_1, rest.gradient_2);
    t.corner[rest.corner] = self.index;
    t.end[rest.corner] = own;
    for (uint k = 0; k < 2; ++k)
    {
        const uint to = (rest.corner + 1 + k) % 3;
        t.corner[to] = others[k];
        t.end[to] = end_at(others[k], positions[others[k]].w);
    }
    return t;
}

// |F d| at the start of the passes.
float length_before(LimitTriangle t, vec3 along)
{
    const vec3 first = step_positions[t.corner[0]].xyz;
    return length(along.y * (step_positions[t.corner[1]].xyz - first) + along.z * (step_positions[t.corner[2]].xyz - first));
}

// `d`: a unit vector of the fabric.
void add_limit_along(inout Correction correction, LimitTriangle t, vec2 d, float limit)
{
    const vec3 along = vec3(dot(t.gradient[0], d), dot(t.gradient[1], d), dot(t.gradient[2], d)); // 1/m
    const float steepest = max(abs(along.x), max(abs(along.y), abs(along.z)));
    const vec3 parts = along / max(steepest, 1e-30); // squares of gradients of slivers leave the range of floats
    const vec3 masses = vec3(t.end[0].inverse_mass, t.end[1].inverse_mass, t.end[2].inverse_mass);
    const float moved = dot(masses, parts * parts);
    const vec3 stretched = along.y * (t.end[1].x - t.end[0].x) + along.z * (t.end[2].x - t.end[0].x);
    const float stretch = length(stretched);
    const float longest = 1 + limit;
    const bool is_short = stretch < 1 && stretch < length_before(t, along);
    if (moved == 0 || stretch == 0 || (!is_short && stretch < k_taut * longest))
        return;
    const vec3 n = stretched / stretch;
    const vec3 owns = masses * parts / moved; // the corners' of a correction
    const float own = owns[t.own];
    // What a corner takes, as an end of a spring takes a half or, if the other end is pinned, all. A light corner far from the
    // direction takes more, and has to take it slowly.
    const vec3 taken = 0.5 * abs(owns) * dot(abs(parts), vec3(1));
    add_stiffness(correction.taken, taken[t.own], n, 1);
    const float relaxation = min(t.end[0].relaxation, min(t.end[1].relaxation, t.end[2].relaxation)) /
                             max(1, max(taken.x, max(taken.y, taken.z)));
    const float weight = relaxation * own / steepest; // m
    if (is_short)
    {
        correction.x += weight * (min(1, length_before(t, along)) - stretch) * n;
        return;
    }
    const vec3 rate = along.y * (t.end[1].v - t.end[0].v) + along.z * (t.end[2].v - t.end[0].v);
    correction.x -= weight * max(stretch - longest, 0) * n;
    correction.v -= weight * max(dot(rate, n), 0) * n;
}

Correction limit_triangles(PatchVertex self)
{
    Correction correction = k_no_correction;
    const End end = end_at(self.index, positions[self.index].w);
    const MeshVertex vertex = mesh_vertices[cloths[self.cloth].first_list + self.local];
    const float limit = cloths[self.cloth].strain_limit;
    const float shear_limit = diagonal_limit(self.cloth);
    const float k_half = 0.70710678;
    for (uint k = 0; k < vertex.corners && end.inverse_mass > 0; ++k)
    {
        const LimitTriangle t = limit_triangle(self, end, vertex.first_corner + k * MESH_STRIDE);
        add_limit_along(correction, t, vec2(1, 0), limit);
        add_limit_along(correction, t, vec2(0, 1), limit);
        add_limit_along(correction, t, vec2(k_half, k_half), shear_limit);
        add_limit_along(correction, t, vec2(k_half, -k_half), shear_limit);
    }
    return correction;
}

#endif
