// The wide levels of a cloth whose levels are listed (limit_levels.cpp). Slots are the entries after its vertices.
//
// The including kernel declares cloths[], velocities[], limit_vertices[], limit_levels[], limit_links[],
// limit_parents[], displacements[], vs[], indices[], Levels and end_at.
#ifndef VOILE_LIMIT_COARSE_LISTED_GLSL
#define VOILE_LIMIT_COARSE_LISTED_GLSL

uint vertices_of(Levels levels) { return uint(levels.lines.x > 0 ? levels.lines.x * levels.lines.y : levels.lines.y); }

LimitVertex listed_entry(Levels levels, uint slot)
{
    return limit_vertices[cloths[levels.cloth].first_limit + vertices_of(levels) + slot];
}

int listed_top(Levels levels, uint slot) { return int(listed_entry(levels, slot).top); }

// Entries are ordered by level, the widest first.
uint listed_slot_at(Levels levels, int level, uint k) { return listed_top(levels, k) >= level ? k : k_no_slot; }

void find_listed(inout Levels levels)
{
    levels.slots = min(vertices_of(levels), VOILE_LIMIT_COARSE_VERTICES);
    levels.widest = listed_top(levels, 0);
}

uint listed_index(Levels levels, uint slot)
{
    return cloths[levels.cloth].first_vertex + listed_entry(levels, slot).other;
}

uint slot_of(Levels levels, uint vertex) { return limit_vertices[cloths[levels.cloth].first_limit + vertex].other; }

// `at`: this pass, the level, the number of the pass on it.
Correction listed_correction(Levels levels, uint slot, uvec3 at)
{
    const bool is_first = at.z == 0;
    const LimitLevel own = limit_levels[listed_entry(levels, slot).first_level + at.y];
    const End end = end_at(slot, at.x, own.inverse_mass, is_first);
    const float limit = cloths[levels.cloth].strain_limit;
    const float shear_limit = diagonal_limit(levels.cloth);
    Correction correction = k_no_correction;
    for (uint first = 0; first < own.links; first += VOILE_LEVEL_NEIGHBORS)
    {
        End others[VOILE_LEVEL_NEIGHBORS]; // all are loaded before the first is used
        float longest[VOILE_LEVEL_NEIGHBORS];
        for (uint k = 0; k < VOILE_LEVEL_NEIGHBORS; ++k)
        {
            const bool exists = first + k < own.links;
            const LimitLink link = limit_links[own.first_link + min(first + k, own.links - 1)];
            const uint to = exists ? slot_of(levels, link.neighbor) : slot; // the vertex itself stands for one that is missing
            others[k] = end_at(to, at.x, link.inverse_mass, is_first);
            longest[k] = (1 + mix(limit, shear_limit, link.shear)) * link.rest_length;
        }
        for (uint k = 0; k < VOILE_LEVEL_NEIGHBORS; ++k)
            add_limit(correction, end, others[k], longest[k], 0);
    }
    return correction;
}

Correction listed_between(Levels levels, uint slot, uint now)
{
    const LimitVertex entry = listed_entry(levels, slot);
    Correction mean = k_no_correction;
    for (uint k = 0; k < entry.parents; ++k)
    {
        const LimitParent parent = limit_parents[entry.first_parent + k];
        const uint to = slot_of(levels, parent.vertex);
        mean.x += parent.weight * displacements[now][to].xyz;
        mean.v += parent.weight * (vs[to].xyz - velocities[indices[to]].xyz);
    }
    return mean;
}

#endif
