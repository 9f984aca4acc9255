// The neighbors of a vertex on the finest level of the strain limit, for the passes that smooth velocities after it.
// A pair of neighbors is an ideal dashpot between their velocities, less those of a local rotation.
//
// The including kernel declares cloths[], limit_vertices[], limit_levels[], limit_links[], positions[], velocities[]
// and step_velocities[].
#ifndef VOILE_LIMIT_NEIGHBORS_GLSL
#define VOILE_LIMIT_NEIGHBORS_GLSL

#include "constraints/limit_levels.glsl"
#include "constraints/limit_spring.glsl"

struct Neighborhood
{
    PatchVertex self;
    uint first_link;
    uint count;
    bool listed;
};

Neighborhood neighborhood(PatchVertex self)
{
    const uint first_limit = cloths[self.cloth].first_limit;
    if (first_limit == VOILE_NO_LIMIT_LEVELS)
        return Neighborhood(self, 0, VOILE_LEVEL_NEIGHBORS, false);
    const LimitLevel finest = limit_levels[limit_vertices[first_limit + self.local].first_level];
    return Neighborhood(self, finest.first_link, finest.links, true);
}

// The k-th, or the vertex itself where there is none.
uint neighbor_index(Neighborhood n, uint k)
{
    const uint cloth = n.self.cloth;
    if (n.listed)
        return k < n.count ? cloths[cloth].first_vertex + limit_links[n.first_link + k].neighbor : n.self.index;
    const ivec2 offset = level_offset(int(k));
    const bool exists = cloths[cloth].springs[level_class(int(k))].stiffness > 0 &&
                        in_grid(n.self.column_row + offset, n.self.columns, n.self.rows);
    return exists ? neighbor(n.self.index, offset, n.self.columns) : n.self.index;
}

struct VertexState
{
    vec3 x; // m
    vec3 v; // m/s
    float inverse_mass;
};

VertexState state_of(uint index)
{
    const vec4 x = positions[index];
    return VertexState(x.xyz, velocities[index].xyz, limit_inverse_mass(x.w, step_velocities[index].w));
}

// Of two inverse masses; 0 between vertices that cannot move.
float reduced_mass(float a, float b) { return a + b > 0 ? 1 / (a + b) : 0; }

// Of a relative velocity, per pair of neighbors. Eight pairs take no more than all of the shortest wave.
const float k_smoothing = 0.2;

// Vertices with more neighbors than a grid take less from each.
float smoothing_part(uint neighbors) { return min(1, float(VOILE_LEVEL_NEIGHBORS) / float(max(neighbors, 1u))); }

bool is_smoothed(PatchVertex self)
{
    return self.exists && !self.asleep && cloths[self.cloth].strain_limit > 0 && is_softened(self.cloth);
}

#endif
