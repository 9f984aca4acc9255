// The springs of a grid's vertex. Included by forces.glsl, after mesh_forces.glsl.
#ifndef VOILE_GRID_FORCES_GLSL
#define VOILE_GRID_FORCES_GLSL

// On a grid. If it does not exist, the vertex takes its role: differences are 0, the spring has no force, and no branch
// keeps loads from being issued together.
Neighbor neighbor_of(Gather g, PatchVertex self, ivec2 offset, bool exists)
{
    const uint other = exists ? neighbor(self.index, offset, self.columns) : self.index;
    return Neighbor(delta_to(g, other), stage_velocities[other].xyz - g.v);
}

// A spring to a neighbor on a grid, and bending. Returns the displacement to the neighbor, m.
vec3 add_neighbor(inout Gather g, PatchVertex self, ivec2 offset, bool exists, SpringClass spring, float bending)
{
    const Neighbor other = neighbor_of(g, self, offset, exists);
    add_spring(g, spring.stiffness, spring.damping, spring.rest_length, other.delta, other.velocity);
    add_bending(g, other, bending);
    return other.delta;
}

// Both neighbors two lines away, ahead and behind, which may have springs, bending alone, or nothing.
void add_far_neighbors(inout Gather g, PatchVertex self, ivec2 offset, bvec2 exist, SpringClass spring, float bending)
{
    if (has_springs(spring))
    {
        add_neighbor(g, self, offset, exist.x, spring, bending);
        add_neighbor(g, self, -offset, exist.y, spring, bending);
    }
    else if (bending != 0)
    {
        add_bending(g, neighbor_of(g, self, offset, exist.x), bending);
        add_bending(g, neighbor_of(g, self, -offset, exist.y), bending);
    }
}

// Whether the grid has lines next to the vertex's, on either side.
struct AdjacentLines
{
    bvec2 next; // ahead, behind
    bvec2 far;
};

AdjacentLines adjacent_lines(int line, uint lines)
{
    return AdjacentLines(bvec2(uint(line + 1) < lines, line > 0), bvec2(uint(line + 2) < lines, line > 1));
}

// Weights of the neighbors along one line in the bending energy 1/2 c sum |x[i-1] - 2 x[i] + x[i+1]|^2 over the line's
// inner vertices. The force is the sum of the weights times the displacements.
struct LineBending
{
    vec2 next;
    float far;
};

LineBending line_bending(AdjacentLines line, float c)
{
    const float middle = all(line.next) ? 2 * c : 0;
    return LineBending(vec2(middle) + 2 * c * vec2(line.far), -c);
}

// Scales of the stiffness along the row and along the column, which differ from 1 at the grid's border.
vec2 border_scales(uint cloth, PatchVertex self)
{
    const float border = cloths[cloth].border_scale;
    return vec2(self.column_row.y == 0 || self.column_row.y + 1 == int(self.rows) ? border : 1,
                self.column_row.x == 0 || self.column_row.x + 1 == int(self.columns) ? border : 1);
}

SpringClass grid_springs(uint cloth, int c, vec2 border, StabilityScales scales)
{
    const float scale = c % 4 == 0 ? border.x : c % 4 == 1 ? border.y : 1;
    return scaled(cloths[cloth].springs[c], scale, scales);
}

// m, to the neighbors along the lines.
struct Sides
{
    vec3 east;
    vec3 west;
    vec3 south;
    vec3 north;
};

// The lines around a vertex, and the weights of its neighbors in the bending energy.
struct GridNeighbors
{
    AdjacentLines row;
    AdjacentLines column;
    vec2 row_next; // ahead, behind
    vec2 column_next;
    float row_far;
    float column_far;
    float twist;
    vec2 border; // scales of the stiffness
};

// Neighbors are taken one after the other to save registers.
Sides add_neighbors(inout Gather g, uint cloth, PatchVertex self, GridNeighbors lines, StabilityScales scales)
{
    const AdjacentLines row = lines.row;
    const AdjacentLines column = lines.column;
    SpringClass springs[VOILE_SPRING_CLASSES];
    for (int c = 0; c < VOILE_SPRING_CLASSES; ++c)
        springs[c] = grid_springs(cloth, c, lines.border, scales);
    Sides sides;
    sides.east = add_neighbor(g, self, ivec2(1, 0), row.next.x, springs[0], lines.row_next.x);
    sides.west = add_neighbor(g, self, ivec2(-1, 0), row.next.y, springs[0], lines.row_next.y);
    sides.south = add_neighbor(g, self, ivec2(0, 1), column.next.x, springs[1], lines.column_next.x);
    sides.north = add_neighbor(g, self, ivec2(0, -1), column.next.y, springs[1], lines.column_next.y);
    add_neighbor(g, self, ivec2(1, 1), row.next.x && column.next.x, springs[2], -lines.twist);
    add_neighbor(g, self, ivec2(-1, -1), row.next.y && column.next.y, springs[2], -lines.twist);
    add_neighbor(g, self, ivec2(1, -1), row.next.x && column.next.y, springs[3], -lines.twist);
    add_neighbor(g, self, ivec2(-1, 1), row.next.y && column.next.x, springs[3], -lines.twist);
    add_far_neighbors(g, self, ivec2(2, 0), row.far, springs[4], lines.row_far);
    add_far_neighbors(g, self, ivec2(0, 2), column.far, springs[5], lines.column_far);
    if (has_springs(cloths[cloth].springs[6]))
    {
        add_neighbor(g, self, ivec2(2, 2), row.far.x && column.far.x, springs[6], 0);
        add_neighbor(g, self, ivec2(-2, -2), row.far.y && column.far.y, springs[6], 0);
        add_neighbor(g, self, ivec2(2, -2), row.far.x && column.far.y, springs[7], 0);
        add_neighbor(g, self, ivec2(-2, 2), row.far.y && column.far.x, springs[7], 0);
    }
    return sides;
}

// Columns and rows from a vertex to its neighbors, plus 2, in four bits each, in the order in which they are added.
const uvec2 k_neighbor_columns = uvec2(0x13132213u, 0x04042204u);
const uvec2 k_neighbor_rows = uvec2(0x31131322u, 0x40040422u);

ivec2 neighbor_offset(uint k)
{
    const uint shift = 4 * (k & 7);
    const uint columns = (k < 8 ? k_neighbor_columns.x : k_neighbor_columns.y) >> shift & 15u;
    const uint rows = (k < 8 ? k_neighbor_rows.x : k_neighbor_rows.y) >> shift & 15u;
    return ivec2(int(columns) - 2, int(rows) - 2);
}

float neighbor_weight(GridNeighbors lines, uint k)
{
    const vec2 next = k < 2 ? lines.row_next : k < 4 ? lines.column_next : vec2(-lines.twist);
    const float far = k < 10 ? lines.row_far : k < 12 ? lines.column_far : 0;
    return k < 8 ? ((k & 1) == 0 ? next.x : next.y) : far;
}

// The same in a loop, with the same bits. Faster on CPU devices, slower on GPUs (bench/NOTES.md).
Sides add_neighbors_in_loop(inout Gather g, uint cloth, PatchVertex self, GridNeighbors lines, StabilityScales scales)
{
    const bool far = has_springs(cloths[cloth].springs[4]) || has_springs(cloths[cloth].springs[5]) ||
                     lines.row_far != 0 || lines.column_far != 0;
    const uint count = has_springs(cloths[cloth].springs[6]) ? 16 : far ? 12 : 8;
    Sides sides = Sides(vec3(0), vec3(0), vec3(0), vec3(0));
    [[dont_unroll]] for (uint k = 0; k < count; ++k)
    {
        const ivec2 offset = neighbor_offset(k);
        const bool exists = in_grid(self.column_row + offset, self.columns, self.rows);
        const SpringClass spring = grid_springs(cloth, int(k / 2), lines.border, scales);
        const vec3 delta = add_neighbor(g, self, offset, exists, spring, neighbor_weight(lines, k));
        sides.east = k == 0 ? delta : sides.east;
        sides.west = k == 1 ? delta : sides.west;
        sides.south = k == 2 ? delta : sides.south;
        sides.north = k == 3 ? delta : sides.north;
    }
    return sides;
}

// Eight springs per vertex, and bending from the same neighbors. The isometric model (Bergou et al. 2006, "A quadratic
// bending model for inextensible surfaces": |Laplacian of x|^2 is quadratic in x where lengths are kept) is, on a grid,
// the sum of the squared second differences along rows and columns and of twice the squared twist of the cells,
// x_diagonal - x_along_row - x_along_column + x.
void gather_grid(inout Gather g, uint cloth, PatchVertex self, StabilityScales scales)
{
    GridNeighbors lines;
    lines.border = border_scales(cloth, self);
    lines.row = adjacent_lines(self.column_row.x, self.columns);
    lines.column = adjacent_lines(self.column_row.y, self.rows);
    const vec2 c = lines.border * cloths[cloth].bending.xy;
    const LineBending row = line_bending(lines.row, c.x);
    const LineBending column = line_bending(lines.column, c.y);
    lines.twist = cloths[cloth].bending.z;
    // Each neighbor along a line belongs to the cells on both of its sides.
    lines.row_next = row.next + lines.twist * (float(lines.column.next.x) + float(lines.column.next.y));
    lines.column_next = column.next + lines.twist * (float(lines.row.next.x) + float(lines.row.next.y));
    lines.row_far = row.far;
    lines.column_far = column.far;
    Sides sides;
    if (FORCE_PARTS == 1)
        sides = add_neighbors_in_loop(g, cloth, self, lines, scales);
    else
        sides = add_neighbors(g, cloth, self, lines, scales);
    if (feels_air(cloth))
    {
        // The vertex takes a quarter of each cell around it: half of the triangle that two sides span.
        add_air(g, cloth, sides.east, sides.north, 0.5);
        add_air(g, cloth, sides.north, sides.west, 0.5);
        add_air(g, cloth, sides.west, sides.south, 0.5);
        add_air(g, cloth, sides.south, sides.east, 0.5);
    }
}

#endif
