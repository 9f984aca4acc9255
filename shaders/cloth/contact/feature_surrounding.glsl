// The triangles around a vertex in the space of a collider, now and at the next query.
//
// The including kernel declares velocities[] and push (NearFeaturesPush), and `FinePosition position_of(uint vertex)`, and
// includes box.glsl, patch.glsl, collider_pose.glsl and feature_fan.glsl before.
#ifndef VOILE_FEATURE_SURROUNDING_GLSL
#define VOILE_FEATURE_SURROUNDING_GLSL

// The vertices of the triangles around a vertex, and of its cell.
uint around_count(PatchVertex self) { return self.columns > 0 ? 8 : cell_count(self); }

// False: outside of the grid.
bool find_around(PatchVertex self, uint i, out uint vertex)
{
    if (self.columns == 0)
        return find_in_cell(self, i, vertex);
    const ivec2 to = i == 0 ? ivec2(0) : i == 7 ? ivec2(1) : k_ring[i - 1];
    vertex = neighbor(self.index, to, self.columns);
    return in_grid(self.column_row + to, self.columns, self.rows);
}

// Of the vertices around one in a grid: whether its pieces have it.
bool is_in_cell(uint i) { return i <= 2 || i == 7; }

// The triangles around a vertex in the space of a collider.
struct Surrounding
{
    Box cell;      // of the vertices that its pieces have, now
    Box box;       // of all, now
    Box later;     // at the next pass, where the velocities lead
    float longest; // m, the longest displacement of a vertex
};

Surrounding surrounding(PatchVertex self, uint c, uint flags)
{
    const Box none = Box(vec3(3e38), vec3(-3e38));
    Surrounding result = Surrounding(none, none, none, 0);
    const bool moves = is_moved(flags);
    Pose start;
    Pose end;
    if (moves)
    {
        start = pose_at(c, push.progress_from);
        end = pose_at(c, push.progress_to);
    }
    const uint count = around_count(self);
    for (uint i = 0; i < count; ++i)
    {
        uint vertex;
        if (!find_around(self, i, vertex))
            continue;
        vec3 from = from_origin(c, flags, position_of(vertex));
        vec3 to = from + seconds(push.substeps) * velocities[vertex].xyz;
        if (moves)
        {
            from = to_collider(start, from);
            to = to_collider(end, to);
        }
        if (self.columns == 0 || is_in_cell(i))
            result.cell = joined(result.cell, Box(from, from));
        result.box = joined(result.box, Box(from, from));
        result.later = joined(result.later, Box(to, to));
        result.longest = max(result.longest, distance(from, to));
    }
    return result;
}

#endif
