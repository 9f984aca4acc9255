// The triangles and edges around a vertex of a cloth, and their motion within a substep.
//
// The including kernel declares cloths[], mesh_vertices[], mesh_corners[], earlier_positions[], proposed_positions[],
// the residuals of both and proposed_velocities[], and includes box.glsl, patch.glsl, collider_pose.glsl and
// feature_fan.glsl before.
#ifndef VOILE_FEATURE_PIECES_GLSL
#define VOILE_FEATURE_PIECES_GLSL

// The vertex of this thread.
struct Self
{
    PatchVertex vertex;
    FinePosition earlier; // before the substep
    FinePosition proposed;
    float inverse_mass;
    vec3 velocity;
    float thickness;
};
Self self;

// The current collider, whose space positions are in.
uint collider_index;
uint collider_flags;
bool collider_moves;
Pose pose_from; // at the substep's start
Pose pose_to;   // at its end
Pose pose_listed; // when near features were listed
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
        pose_listed = pose_at(c, push.progress_listed);
        change_of_pose = pose_change(c, push.progress_from, push.progress_to);
    }
}

// m, world: the displacement of a point of the collider's space that moves by `moved` in that space.
vec3 carried_displacement(vec3 point, vec3 moved)
{
    if (!collider_moves)
        return moved;
    return displacement(pose_from, change_of_pose, point) + rotate(pose_to.rotation, moved);
}

// A vertex of the cloth in the collider's space, before the substep and as proposed.
struct SweptVertex
{
    vec3 from;
    vec3 to;
    vec3 velocity; // m/s, world
    float inverse_mass;
    vec3 displaced; // m, world, within the substep
};

FinePosition earlier_position(uint index)
{
    return FinePosition(earlier_positions[index].xyz, unpack_residual(earlier_residuals[index]));
}

FinePosition proposed_position(uint index)
{
    return FinePosition(proposed_positions[index].xyz, unpack_residual(proposed_residuals[index]));
}

SweptVertex swept_vertex(FinePosition earlier, FinePosition proposed, vec3 velocity, float inverse_mass)
{
    SweptVertex result = SweptVertex(from_origin(collider_index, collider_flags, earlier),
                                     from_origin(collider_index, collider_flags, proposed), velocity, inverse_mass,
                                     displacement(earlier, proposed));
    if (collider_moves)
    {
        result.from = to_collider(pose_from, result.from);
        result.to = to_collider(pose_to, result.to);
    }
    return result;
}

SweptVertex swept_vertex(uint index)
{
    return swept_vertex(earlier_position(index), proposed_position(index), proposed_velocities[index].xyz,
                        proposed_positions[index].w);
}

// The vertex and two of its neighbors. Features are tested one after the other, so their common input is kept here.
struct Piece
{
    SweptVertex a; // the vertex
    SweptVertex b;
    SweptVertex c;
    bool triangle;    // (a, b, c) is a triangle without pinned vertices
    bool edge_b;      // (a, b) is an edge without pinned vertices
    bool edge_c;
    vec3 across;      // unit normal of the triangle
    vec3 across_then; // before the substep
};
Piece piece;

// Prepares a piece whose vertices are loaded. `triangle`: (a, b, c) is one. False: it is not finite and has no box.
bool orient_piece(bool triangle)
{
    const vec3 normal = cross(piece.b.to - piece.a.to, piece.c.to - piece.a.to);
    const vec3 earlier = cross(piece.b.from - piece.a.from, piece.c.from - piece.a.from);
    if (!(dot(normal, normal) + dot(earlier, earlier) < 3e38))
        return false;
    piece.triangle = triangle && min(min(piece.a.inverse_mass, piece.b.inverse_mass), piece.c.inverse_mass) > 0 &&
                     dot(normal, normal) >= 1e-30 && dot(earlier, earlier) >= 1e-30;
    piece.across = normalize(normal);
    piece.across_then = normalize(earlier);
    return true;
}

// Loads the k-th piece around the vertex. False: none.
bool load_piece(uint k)
{
    const bool is_grid = self.vertex.columns > 0;
    uint b;
    uint c;
    const bool has_c = find_corner(self.vertex, k, b, c);
    if (is_grid && !in_grid(self.vertex.column_row + k_ring[k], self.vertex.columns, self.vertex.rows))
        return false;
    piece.b = swept_vertex(b);
    piece.c = piece.b;
    if (has_c)
        piece.c = swept_vertex(c);
    piece.edge_b = piece.b.inverse_mass > 0;
    piece.edge_c = !is_grid && piece.c.inverse_mass > 0; // a grid tests it with another k
    return orient_piece(has_c);
}

// The ball whose diameter is a motion. Whatever planes through its start stop of the motion ends within it (Thales).
Box thales_box(vec3 from, vec3 to) { return grown(Box(0.5 * (from + to), 0.5 * (from + to)), 0.5 * distance(from, to)); }

// Where a vertex may be after its contacts, give or take the thickness.
Box held_box(SweptVertex vertex) { return thales_box(vertex.from, vertex.to); }

// `held`: wherever guards may hold it.
Box vertex_box(SweptVertex vertex, bool held) { return held ? held_box(vertex) : box_around(vertex.from, vertex.to); }

Box piece_box(bool held)
{
    return joined(vertex_box(piece.a, held), joined(vertex_box(piece.b, held), vertex_box(piece.c, held)));
}

#endif
