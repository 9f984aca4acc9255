// The triangles and edges around a vertex of a cloth, one after the other, and where they go in a substep.
//
// The including kernel declares cloths[], mesh_vertices[], mesh_corners[], earlier_positions[], proposed_positions[], the
// residuals of both and proposed_velocities[], and includes patch.glsl, collider_pose.glsl and mesh.glsl before.
#ifndef VOILE_FEATURE_PIECES_GLSL
#define VOILE_FEATURE_PIECES_GLSL

// The vertices around one, in order: those of a grid's two triangles a cell, cut from (column + 1, row) to (column, row + 1).
const ivec2 k_ring[6] = ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(0, -1), ivec2(1, -1));

// The vertex of this thread.
struct Self
{
    PatchVertex vertex;
    FinePosition earlier; // before the substep
    FinePosition place;   // proposed
    float inverse_mass;
    vec3 velocity;
    float thickness;
};
Self self;

// The collider that is being looked at, in whose space places are.
uint collider_index;
uint collider_flags;
bool collider_moves;
Pose pose_from; // at the substep's start
Pose pose_to;   // at its end
PoseChange change_of_pose;

void select_collider(uint c)
{
    collider_index = c;
    collider_flags = colliders[c].flags;
    collider_moves = is_moved(collider_flags);
    if (collider_moves)
    {
        pose_from = pose_at(c, push.progress_from);
        pose_to = pose_at(c, push.progress_to);
        change_of_pose = pose_change(c, push.progress_from, push.progress_to);
    }
}

// By how much the surface moves in the substep where the vertex is, m, world.
vec3 surface_displacement()
{
    if (!collider_moves)
        return vec3(0);
    const vec3 point = to_collider(pose_from, from_origin(collider_index, collider_flags, self.earlier));
    return displacement(pose_from, change_of_pose, point);
}

// A vertex of the cloth: where it was before the substep and where it is, in the collider's space.
struct Traveller
{
    vec3 from;
    vec3 to;
    vec3 velocity; // m/s, world
    float inverse_mass;
};

FinePosition earlier_position(uint index)
{
    return FinePosition(earlier_positions[index].xyz, unpack_residual(earlier_residuals[index]));
}

FinePosition proposed_position(uint index)
{
    return FinePosition(proposed_positions[index].xyz, unpack_residual(proposed_residuals[index]));
}

Traveller traveller(FinePosition earlier, FinePosition place, vec3 velocity, float inverse_mass)
{
    Traveller result = Traveller(from_origin(collider_index, collider_flags, earlier),
                                 from_origin(collider_index, collider_flags, place), velocity, inverse_mass);
    if (collider_moves)
    {
        result.from = to_collider(pose_from, result.from);
        result.to = to_collider(pose_to, result.to);
    }
    return result;
}

Traveller traveller(uint index)
{
    return traveller(earlier_position(index), proposed_position(index), proposed_velocities[index].xyz,
                     proposed_positions[index].w);
}

// How many triangles there may be around the vertex.
uint corner_count()
{
    return cloths[self.vertex.cloth].columns > 0
               ? 6
               : mesh_vertices[cloths[self.vertex.cloth].first_list + self.vertex.local].corners;
}

// The other two corners of one of them. False where a grid ends; `b` may be there all the same.
bool find_corner(uint k, out uint b, out uint c)
{
    const ClothRecord cloth = cloths[self.vertex.cloth];
    if (cloth.columns == 0)
    {
        const uint first = mesh_vertices[cloth.first_list + self.vertex.local].first_corner;
        const MeshCorner corner = mesh_corners[first + k * MESH_STRIDE];
        b = cloth.first_vertex + corner.b;
        c = cloth.first_vertex + corner.c;
        return true;
    }
    const ivec2 to_b = k_ring[k];
    const ivec2 to_c = k_ring[(k + 1) % 6];
    b = neighbor(self.vertex.index, to_b, cloth.columns);
    c = neighbor(self.vertex.index, to_c, cloth.columns);
    return in_grid(self.vertex.place + to_b, cloth.columns, cloth.rows) &&
           in_grid(self.vertex.place + to_c, cloth.columns, cloth.rows);
}

// What the vertex and two of its neighbors span. Features meet one after the other, so what they all need is kept.
struct Piece
{
    Traveller a; // the vertex
    Traveller b;
    Traveller c;
    bool triangle;    // (a, b, c) is one whose vertices all move
    bool edge_b;      // (a, b) is an edge whose vertices both move
    bool edge_c;
    vec3 across;      // unit normal of the triangle
    vec3 across_then; // before the substep
};
Piece piece;

// Loads what the vertex spans with its k-th two neighbors. False: nothing that could meet anything.
bool load_piece(uint k)
{
    const ClothRecord cloth = cloths[self.vertex.cloth];
    const bool is_grid = cloth.columns > 0;
    uint b;
    uint c;
    const bool has_c = find_corner(k, b, c);
    if (is_grid && !in_grid(self.vertex.place + k_ring[k], cloth.columns, cloth.rows))
        return false;
    piece.b = traveller(b);
    piece.c = piece.b;
    if (has_c)
        piece.c = traveller(c);
    const vec3 normal = cross(piece.b.to - piece.a.to, piece.c.to - piece.a.to);
    const vec3 earlier = cross(piece.b.from - piece.a.from, piece.c.from - piece.a.from);
    if (!(dot(normal, normal) + dot(earlier, earlier) < 3e38))
        return false; // not finite: its box would be none
    piece.edge_b = piece.b.inverse_mass > 0;
    piece.edge_c = !is_grid && piece.c.inverse_mass > 0; // a grid has it with another k
    piece.triangle = has_c && piece.edge_b && piece.c.inverse_mass > 0 && dot(normal, normal) >= 1e-30 &&
                     dot(earlier, earlier) >= 1e-30;
    piece.across = normalize(normal);
    piece.across_then = normalize(earlier);
    return true;
}

void piece_box(out vec3 low, out vec3 high)
{
    low = min(min(piece.a.from, piece.a.to), min(min(piece.b.from, piece.b.to), min(piece.c.from, piece.c.to)));
    high = max(max(piece.a.from, piece.a.to), max(max(piece.b.from, piece.b.to), max(piece.c.from, piece.c.to)));
}

#endif
