// The wide levels of a grid: its lines (limit_levels.glsl). Slots are the vertices of the finest level, row by row.
//
// The including kernel declares cloths[], velocities[], displacements[], vs[], indices[], Levels and end_at.
#ifndef VOILE_LIMIT_COARSE_GRID_GLSL
#define VOILE_LIMIT_COARSE_GRID_GLSL

// Of a level, along each axis.
ivec2 line_counts(ivec2 lines, int level) { return ((lines - 2 + (1 << level)) >> level) + 1; }

void find_lines(inout Levels levels)
{
    const ivec2 counts = line_counts(levels.lines, levels.finest);
    levels.own_lines = counts.x;
    levels.slots = uint(counts.x * counts.y);
    levels.widest = levels.finest;
    while (1 << levels.widest < max(levels.lines.x, levels.lines.y) - 1)
        ++levels.widest;
}

// Of the k-th vertex of a level.
ivec2 column_row(Levels levels, int level, uint k)
{
    const uint columns = uint(line_counts(levels.lines, level).x);
    return min(ivec2(k % columns, k / columns) << level, levels.lines - 1);
}

uint grid_slot(Levels levels, ivec2 at)
{
    const ivec2 line = (at + (1 << levels.finest) - 1) >> levels.finest;
    return uint(line.y * levels.own_lines + line.x);
}

uint grid_slot_at(Levels levels, int level, uint k)
{
    const ivec2 counts = line_counts(levels.lines, level);
    return k < uint(counts.x * counts.y) ? grid_slot(levels, column_row(levels, level, k)) : k_no_slot;
}

uint grid_index(Levels levels, uint slot)
{
    const ivec2 at = column_row(levels, levels.finest, slot);
    return cloths[levels.cloth].first_vertex + uint(at.y * levels.lines.x + at.x);
}

bool is_between_lines(Levels levels, uint k, int level)
{
    return !on_level(column_row(levels, level, k), levels.lines, 2 << level);
}

// Of the k-th vertex of a level. `at`: this pass, the level, the number of the pass on it.
Correction grid_correction(Levels levels, uint k, uvec3 at)
{
    const int spacing = 1 << at.y;
    const bool is_first = at.z == 0;
    const ivec2 self = column_row(levels, int(at.y), k);
    const vec2 rest =
        vec2(cloths[levels.cloth].springs[0].rest_length, cloths[levels.cloth].springs[1].rest_length);
    const LevelNeighbors n = level_neighbors(self, levels.lines, spacing, cloths[levels.cloth].border_scale);
    End others[VOILE_LEVEL_NEIGHBORS]; // all are loaded before the first is used
    float longest[VOILE_LEVEL_NEIGHBORS];
    for (int s = 0; s < VOILE_LEVEL_NEIGHBORS; ++s)
    {
        const ivec2 offset = level_offset(s);
        const bool has_spring = cloths[levels.cloth].springs[level_class(s)].stiffness > 0;
        const ivec2 to = has_spring ? neighbor_at(n, self, offset) : self; // the vertex itself stands for one that is missing
        others[s] = end_at(grid_slot(levels, to), at.x, inverse_mass_at(n, offset), is_first);
        longest[s] = (1 + level_limit(s, levels.cloth)) * length(vec2(to - self) * rest);
    }
    const End end = end_at(grid_slot(levels, self), at.x, inverse_mass_at(n, ivec2(0)), is_first);
    Correction correction = k_no_correction;
    for (int s = 0; s < VOILE_LEVEL_NEIGHBORS; ++s)
        add_limit(correction, end, others[s], longest[s], 0);
    return correction;
}

// `at`: this pass, the level.
Correction grid_between(Levels levels, uint k, uvec2 at)
{
    const Between b = between_lines(column_row(levels, int(at.y), k), levels.lines, 2 << at.y);
    Correction mean = k_no_correction;
    for (int corner = 0; corner < 4; ++corner)
    {
        const uint to = grid_slot(levels, corner_at(b, corner));
        const float weight = corner_weight(b, corner);
        mean.x += weight * displacements[at.x][to].xyz;
        mean.v += weight * (vs[to].xyz - velocities[indices[to]].xyz);
    }
    return mean;
}

#endif
