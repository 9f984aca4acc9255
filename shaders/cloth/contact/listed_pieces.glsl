// The pieces of cloth that each vertex lists features for.
//
// The including kernel defines FeatureSearch, PieceKind, space_at and position_in, and includes feature_fan.glsl,
// mesh.glsl, triangle.glsl and feature_margin.glsl before.
#ifndef VOILE_LISTED_PIECES_GLSL
#define VOILE_LISTED_PIECES_GLSL

// The number of pieces that a vertex may have, and one of them. False: not this one.
uint piece_count(PatchVertex self) { return self.columns > 0 ? 7 : 3 * corner_count(self); }

bool find_piece(PatchVertex self, uint i, out PieceKind piece)
{
    if (self.columns > 0)
    {
        piece = PieceKind(i < 2 ? VOILE_PIECE_TRIANGLE : VOILE_PIECE_EDGE_B, i);
        const ivec2 next = self.column_row + ivec2(1);
        if (i == 2)
            return uint(next.x) < self.columns;
        if (i == 3)
            return uint(next.y) < self.rows;
        // The last two are edges on the border of the grid.
        return in_grid(next, self.columns, self.rows) && (i != 5 || uint(next.x) + 1 == self.columns) &&
               (i != 6 || uint(next.y) + 1 == self.rows);
    }
    piece = PieceKind(i % 3, i / 3);
    if (piece.kind != VOILE_PIECE_EDGE_C)
        return true;
    // Most edges to a c are those to the b of the next triangle.
    const uint c = mesh_corner(self, piece.k).c;
    const uint count = corner_count(self);
    for (uint k = 0; k < count; ++k)
        if (mesh_corner(self, k).b == c)
            return false;
    return true;
}

Box box_of(Triangle t) { return joined(box_around(t.a, t.b), Box(t.c, t.c)); }

// Notes how the vertices of the piece are expected to move until the next query. Returns where they end.
Box expect_motion(inout FeatureSearch search, uint c, uvec3 vertices)
{
    const Space space = space_at(c, push.progress_to);
    const float time = seconds(push.substeps);
    const Triangle end = Triangle(position_in(space, vertices.x, time), position_in(space, vertices.y, time),
                                  position_in(space, vertices.z, time));
    const mat3 motions = mat3(end.a - search.shape.a, end.b - search.shape.b, end.c - search.shape.c);
    search.motion = (motions[0] + motions[1] + motions[2]) / 3;
    search.spread = max(max(distance(motions[0], search.motion), distance(motions[1], search.motion)),
                        distance(motions[2], search.motion));
    return box_of(end);
}

// Prepares the search around the i-th piece of the vertex. False: there is none.
bool select_piece(inout FeatureSearch search, Space space, uint i)
{
    if (!find_piece(search.self, i, search.piece))
        return false;
    const uvec3 v = piece_vertices(search.self, search.piece.kind, search.piece.k);
    search.shape = Triangle(position_in(space, v.x, 0), position_in(space, v.y, 0), position_in(space, v.z, 0));
    Box shape = box_of(search.shape);
    search.query_radius = query_radius(search.self, max(abs(shape.min), abs(shape.max)));
    if (search.deforms)
        shape = joined(shape, expect_motion(search, search.collider, v));
    search.box = grown(shape, search.query_radius + search.margin);
    return true;
}

#endif
