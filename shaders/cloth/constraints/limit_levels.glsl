// The levels of a grid for the strain limit. A level of a spacing has the lines whose number is a multiple of it, and
// the last line. Vertices of a level are those where its lines cross. All vertices of a level are on the next finer one.
//
// The including kernel declares cloths[].
#ifndef VOILE_LIMIT_LEVELS_GLSL
#define VOILE_LIMIT_LEVELS_GLSL

#include "shared/grid.glsl"

// Spacings are powers of two, and lines are divided by shifts: integer divisions take most of a pass.
bool on_level(int line, int lines, int spacing) { return (line & (spacing - 1)) == 0 || line == lines - 1; }

bool on_level(ivec2 column_row, ivec2 lines, int spacing)
{
    return on_level(column_row.x, lines.x, spacing) && on_level(column_row.y, lines.y, spacing);
}

// The lines of the level before and after a line; the line itself where there is none.
ivec2 adjacent_lines(int line, int lines, int spacing)
{
    return ivec2(max((line - 1) & ~(spacing - 1), 0), min((line & ~(spacing - 1)) + spacing, lines - 1));
}

// The number of lines that move with a line of a level: the sum of their weights, which fall to 0 at the next lines of
// the level. Lines on the border count by their mass.
float lines_with(int line, int lines, int spacing, float border)
{
    const ivec2 beside = adjacent_lines(line, lines, spacing);
    const float self = line == 0 || line == lines - 1 ? border : 1;
    return self + 0.5 * float(max(line - beside.x - 1, 0) + max(beside.y - line - 1, 0));
}

// The strain limit of diagonals of softened cloth, unless that of the cloth is larger. They lengthen as cloth shears, and
// cloth shears to lie on anything round. A limit that works in every step shakes cloth until friction no longer holds
// it: silk of 1 m slid off a sphere of 0.3 m. By 0.2 it shears by 26 degrees.
const float k_diagonal_limit = 0.2;

// The neighbors of a vertex on its level.
struct LevelNeighbors
{
    ivec2 columns; // before, after
    ivec2 rows;
    vec3 column_lines; // that move with the column before, its own and the column after
    vec3 row_lines;
};

vec3 all_lines_with(int line, ivec2 beside, ivec2 lines_and_spacing, float border)
{
    const int lines = lines_and_spacing.x;
    const int spacing = lines_and_spacing.y;
    return vec3(lines_with(beside.x, lines, spacing, border), lines_with(line, lines, spacing, border),
                lines_with(beside.y, lines, spacing, border));
}

LevelNeighbors level_neighbors(ivec2 at, ivec2 lines, int spacing, float border)
{
    LevelNeighbors n;
    n.columns = adjacent_lines(at.x, lines.x, spacing);
    n.rows = adjacent_lines(at.y, lines.y, spacing);
    n.column_lines = all_lines_with(at.x, n.columns, ivec2(lines.x, spacing), border);
    n.row_lines = all_lines_with(at.y, n.rows, ivec2(lines.y, spacing), border);
    return n;
}

// `offset`: -1, 0 or 1 along each axis. The vertex itself where there is no neighbor.
ivec2 neighbor_at(LevelNeighbors n, ivec2 at, ivec2 offset)
{
    const ivec2 to = ivec2(offset.x == 0 ? at.x : offset.x < 0 ? n.columns.x : n.columns.y,
                           offset.y == 0 ? at.y : offset.y < 0 ? n.rows.x : n.rows.y);
    const bvec2 missing = bvec2(offset.x != 0 && to.x == at.x, offset.y != 0 && to.y == at.y);
    return any(missing) ? at : to;
}

// Of all that moves with the neighbor, relative to a vertex in the grid.
float inverse_mass_at(LevelNeighbors n, ivec2 offset) { return 1 / (n.column_lines[offset.x + 1] * n.row_lines[offset.y + 1]); }

// Of a vertex of a grid on its level, and the number of neighbors whose loads are in flight at once.
#define VOILE_LEVEL_NEIGHBORS 8

// Structural and shear springs in both directions: the class and the offset of the k-th of eight.
uint level_class(int k) { return uint(k % 4); }
ivec2 level_offset(int k) { return (k < 4 ? 1 : -1) * k_spring_offsets[k % 4]; }

bool is_softened(uint cloth) { return cloths[cloth].strain_passes == VOILE_SOFTENED_STRAIN_PASSES; }

float diagonal_limit(uint cloth)
{
    const float limit = cloths[cloth].strain_limit;
    return is_softened(cloth) ? max(limit, k_diagonal_limit) : limit;
}

// The strain limit of the spring to the k-th of eight neighbors.
float level_limit(int k, uint cloth)
{
    return level_class(k) >= 2 ? diagonal_limit(cloth) : cloths[cloth].strain_limit;
}

// Where a vertex lies between lines of the level before: it takes their displacements by weight.
struct Between
{
    ivec2 columns;
    ivec2 rows;
    vec2 weight; // of the second of each
};

Between between_lines(ivec2 at, ivec2 lines, int spacing)
{
    Between b;
    b.columns = on_level(at.x, lines.x, spacing) ? ivec2(at.x) : adjacent_lines(at.x, lines.x, spacing);
    b.rows = on_level(at.y, lines.y, spacing) ? ivec2(at.y) : adjacent_lines(at.y, lines.y, spacing);
    b.weight = vec2(at - ivec2(b.columns.x, b.rows.x)) / vec2(max(ivec2(b.columns.y - b.columns.x, b.rows.y - b.rows.x), 1));
    return b;
}

ivec2 corner_at(Between b, int corner) { return ivec2(b.columns[corner % 2], b.rows[corner / 2]); }

float corner_weight(Between b, int corner)
{
    return (corner % 2 == 0 ? 1 - b.weight.x : b.weight.x) * (corner / 2 == 0 ? 1 - b.weight.y : b.weight.y);
}

#endif
