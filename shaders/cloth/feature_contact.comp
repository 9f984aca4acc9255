#version 460
#extension GL_GOOGLE_include_directive : require
// Contact of corners and edges of colliders with the triangles and edges of all cloths: what vertices alone miss where a
// collider stands between them. One thread a vertex, which looks at the triangles around it and takes its share.
//
// A triangle's vertices go along straight lines in the substep. Where it comes nearer than the thickness, or goes through,
// it is put back at the thickness, shared out by the barycentric coordinates of the place; approaching velocity is removed,
// and Coulomb friction acts. Pieces with a held vertex go where that is held. The vertices' own contact comes after and has the
// last word.
// Reads: the chunks that are near (feature_reach.comp), cloths, chunks, mesh lists, colliders and their motions, features and
// their hierarchy, positions before the substep, proposed state.
// Writes: corrections of vertices that meet something, which the contact pass adds to the proposed state; predicted velocities.
#include "bvh_layout.h"
#include "cloth_layout.h"
#include "feature_layout.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 3) const uint COLLIDERS_MOVE = 1;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Chunks { Chunk chunks[]; };
layout(set = 0, binding = 2, std430) readonly buffer ProposedPositions { vec4 proposed_positions[]; };
layout(set = 0, binding = 3, std430) readonly buffer ProposedVelocities { vec4 proposed_velocities[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Corrections { FeatureCorrection corrections[]; };
layout(set = 0, binding = 5, std430) readonly buffer NearChunks { uint near_chunks[]; };
layout(set = 0, binding = 6, std430) buffer Predicted { vec4 predicted[]; }; // of cloths that use Verlet
layout(set = 0, binding = 7, std430) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(set = 0, binding = 8, std430) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(set = 0, binding = 9, std430) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(set = 0, binding = 10, std430) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(set = 0, binding = 11, std430) readonly buffer FeatureSets { FeatureSet feature_sets[]; };
layout(set = 0, binding = 12, std430) readonly buffer FeatureNodes { BvhNode bvh_nodes[]; };
layout(set = 0, binding = 13, std430) readonly buffer Features { Feature features[]; };
layout(set = 0, binding = 14, std430) readonly buffer EarlierPositions { vec4 earlier_positions[]; }; // before the substep

layout(push_constant, std430) uniform Push { FeaturePush push; };

#include "chunk.glsl"
#include "collider_pose.glsl"
#include "friction.glsl"
#include "mesh.glsl"

// The vertices around one, in order: those of a grid's two triangles a cell, cut from (column + 1, row) to (column, row + 1).
const ivec2 k_ring[6] = ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(0, -1), ivec2(1, -1));
// Edges nearer to parallel than this sine have no direction across.
const float k_parallel = 0.03;
// A cosine: so far beyond the limit a direction must be to be inside for certain.
const float k_certain = 0.2;
// m/s, at which cloth comes away from what it is nearer to than the thickness.
const float k_recovery = 0.2;
// Barycentric coordinates this far below 0 count as inside, so that no place between two triangles is lost.
const float k_border = 1e-3;

// The vertex of this thread, and what its contacts have changed so far.
struct Self
{
    ChunkVertex vertex;
    vec3 earlier;  // m, before the substep
    vec4 place;    // proposed; w: inverse mass
    vec3 velocity;
    float thickness;
    vec2 friction; // static, kinetic; of the pair
    vec3 shift;    // m
    vec3 change;   // m/s, across surfaces
    vec3 slowing;  // m/s, by friction, of the contact that presses most
    float pressed; // m/s, by which that one presses
    bool meets;    // anything
};
Self self;

// The collider that is being looked at, in whose space places are.
bool collider_moves;
Pose pose_from; // at the substep's start
Pose pose_to;   // at its end

// A vertex of the cloth: where it was before the substep and where it is, in the collider's space.
struct Traveller
{
    vec3 from;
    vec3 to;
    vec3 velocity; // m/s, world
    float inverse_mass;
};

Traveller traveller(vec3 earlier, vec4 place, vec3 velocity)
{
    Traveller result = Traveller(earlier, place.xyz, velocity, place.w);
    if (collider_moves)
    {
        result.from = to_collider(pose_from, result.from);
        result.to = to_collider(pose_to, result.to);
    }
    return result;
}

Traveller traveller(uint index)
{
    return traveller(earlier_positions[index].xyz, proposed_positions[index], proposed_velocities[index].xyz);
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
    b = neighbour(self.vertex.index, to_b, cloth.columns);
    c = neighbour(self.vertex.index, to_c, cloth.columns);
    return in_grid(self.vertex.place + to_b, cloth.columns, cloth.rows) &&
           in_grid(self.vertex.place + to_c, cloth.columns, cloth.rows);
}

// How a feature and a piece of cloth meet.
struct Meeting
{
    bool found;
    vec3 direction; // unit, collider's space: to the side on which the cloth belongs
    float gap;      // m, along it; negative: on the other side
    float wanted;   // m, the gap that there should be
    float time;     // 0..1 of the substep, at which they touch; 1: they are near each other now
};

// Whether a piece of cloth in this direction (unit) from a feature is inside the collider.
//
// A convex edge whose faces' normals lie within the angle c of its own is a wedge. A place is inside if it lies farther
// than 90 deg + c from the normal; a line with its foot there goes through both faces if it lies farther than 180 deg - c.
bool is_behind(Feature feature, vec3 direction)
{
    const float sine = sqrt(max(1 - feature.cosine * feature.cosine, 0));
    return feature.cosine > -1 && dot(direction, feature.normal) < -min(sine, feature.cosine) - k_certain;
}

// The piece of cloth was at `from` along `before` before the substep and is at `to` along `now`: m, unit vectors. It belongs
// to where it was; unless it was inside, and so near that it must have come in here.
Meeting meet(Feature feature, vec3 before, float from, vec3 now, float to)
{
    Meeting result;
    result.found = false;
    if (dot(before, now) <= 0)
        from = to; // it has turned over
    float side = from >= 0 ? 1 : -1;
    if (is_behind(feature, side * now))
    {
        if (abs(from) > self.thickness)
            return result;
        side = -side;
    }
    const float gap_before = side * from - feature.radius;
    result.direction = side * now;
    result.gap = side * to - feature.radius;
    const bool passed = gap_before > 0 && result.gap < 0;
    result.found = result.gap < self.thickness && (passed || result.gap > -self.thickness);
    // What is too near already comes away slowly, or one contact's push would be the next one's miss.
    result.wanted = min(self.thickness, gap_before + k_recovery * push.step);
    result.time = passed ? gap_before / (gap_before - result.gap) : 1;
    return result;
}

// Of the sliding velocity, what friction takes when the surfaces approached at `approach`, m/s.
float friction_share(vec2 coefficients, float approach, float speed)
{
    return speed <= coefficients.x * approach ? 1 : coefficients.y * approach / speed;
}

// `place`: of the feature; `share`: of the vertex in what moves the cloth there; `velocity`: m/s, of the cloth there, world.
void take_share(Meeting meeting, vec3 place, float share, vec3 velocity)
{
    self.meets = true;
    vec3 n = meeting.direction;
    vec3 relative = velocity;
    if (collider_moves)
    {
        n = rotate(pose_to.rotation, n);
        relative -= (to_world(pose_to, place) - to_world(pose_from, place)) / push.step;
    }
    // What other contacts have done in this direction is done.
    self.shift += max(share * (meeting.wanted - meeting.gap) - dot(self.shift, n), 0) * n;
    const float approach = -min(dot(relative, n), 0);
    self.change += max(share * approach - dot(self.change, n), 0) * n;
    if (share * approach <= self.pressed)
        return;
    self.pressed = share * approach;
    const vec3 sliding = relative - dot(relative, n) * n;
    self.slowing = -share * friction_share(self.friction, approach, length(sliding)) * sliding;
}

// By how much the vertex moves for what the place moves.
float share_of(vec3 weights, vec3 inverse_masses)
{
    return inverse_masses.x * weights.x / dot(inverse_masses, weights * weights);
}

// A corner and the triangle of this thread's vertex with b and c.
void meet_triangle(Feature feature, Traveller a, Traveller b, Traveller c)
{
    const vec3 normal = cross(b.to - a.to, c.to - a.to);
    const vec3 earlier = cross(b.from - a.from, c.from - a.from);
    if (dot(normal, normal) < 1e-30 || dot(earlier, earlier) < 1e-30 || min(b.inverse_mass, c.inverse_mass) == 0)
        return;
    const vec3 across = normalize(normal);
    const vec3 across_then = normalize(earlier);
    const Meeting meeting =
        meet(feature, across_then, dot(across_then, a.from - feature.a), across, dot(across, a.to - feature.a));
    if (!meeting.found)
        return;
    const vec3 corner = mix(a.from, a.to, meeting.time);
    const vec3 ab = mix(b.from, b.to, meeting.time) - corner;
    const vec3 ac = mix(c.from, c.to, meeting.time) - corner;
    const vec3 ap = feature.a - corner;
    const vec3 n = cross(ab, ac);
    const float area = max(dot(n, n), 1e-30);
    const float v = dot(cross(ap, ac), n) / area;
    const float w = dot(cross(ab, ap), n) / area;
    if (min(min(v, w), 1 - v - w) < -k_border)
        return;
    const vec3 weights = clamp(vec3(1 - v - w, v, w), vec3(0), vec3(1));
    take_share(meeting, feature.a, share_of(weights, vec3(a.inverse_mass, b.inverse_mass, c.inverse_mass)),
               weights.x * a.velocity + weights.y * b.velocity + weights.z * c.velocity);
}

// An edge and that of the cloth from this thread's vertex to b.
void meet_edge(Feature feature, Traveller a, Traveller b)
{
    const vec3 along = feature.b - feature.a;
    const vec3 ab = b.to - a.to;
    const vec3 normal = cross(ab, along);
    if (dot(normal, normal) <= k_parallel * k_parallel * dot(ab, ab) * dot(along, along) || b.inverse_mass == 0)
        return;
    const vec3 across = normalize(normal);
    const vec3 earlier = cross(b.from - a.from, along);
    // An edge that has turned over, or was parallel, has no side of its own then.
    const bool turned = dot(earlier, normal) <= 0;
    const vec3 across_then = turned ? across : normalize(earlier);
    const Meeting meeting =
        meet(feature, across_then, dot(across_then, a.from - feature.a), across, dot(across, a.to - feature.a));
    if (!meeting.found)
        return;
    // The nearest points of two lines; Ericson 2004, Real-Time Collision Detection, 5.1.8.
    const vec3 start = mix(a.from, a.to, meeting.time);
    const vec3 u = mix(b.from, b.to, meeting.time) - start;
    const vec3 r = start - feature.a;
    const float uu = dot(u, u);
    const float ua = dot(u, along);
    const float aa = dot(along, along);
    const float determinant = max(uu * aa - ua * ua, 1e-30);
    const float s = (ua * dot(along, r) - aa * dot(u, r)) / determinant;
    const float t = (uu * dot(along, r) - ua * dot(u, r)) / determinant;
    if (min(s, t) < 0 || max(s, t) > 1)
        return;
    take_share(meeting, feature.a + t * along,
               share_of(vec3(1 - s, s, 0), vec3(a.inverse_mass, b.inverse_mass, 0)),
               mix(a.velocity, b.velocity, s));
}

void visit_feature(Feature feature)
{
    const bool is_corner = feature.a == feature.b;
    const bool is_grid = cloths[self.vertex.cloth].columns > 0;
    const Traveller a = traveller(self.earlier, self.place, self.velocity);
    const uint count = corner_count();
    for (uint k = 0; k < count; ++k)
    {
        uint b;
        uint c;
        const bool triangle = find_corner(k, b, c);
        if (is_corner && triangle)
            meet_triangle(feature, a, traveller(b), traveller(c));
        if (is_corner)
            continue;
        const ivec2 neighbour_place = self.vertex.place + (is_grid ? k_ring[k] : ivec2(0));
        if (!is_grid || in_grid(neighbour_place, cloths[self.vertex.cloth].columns, cloths[self.vertex.cloth].rows))
            meet_edge(feature, a, traveller(b));
        if (!is_grid)
            meet_edge(feature, a, traveller(c));
    }
}

bool boxes_overlap(vec3 a_min, vec3 a_max, vec3 b_min, vec3 b_max)
{
    return all(lessThanEqual(a_min, b_max)) && all(lessThanEqual(b_min, a_max));
}

void take_leaf(uint first, uint count)
{
    for (uint f = first; f < first + count; ++f)
        visit_feature(features[f]);
}

#include "bvh.glsl"

// m: the farthest neighbour, at either end of the substep.
float ring_radius()
{
    float radius = 0;
    const uint count = corner_count();
    for (uint k = 0; k < count; ++k)
    {
        uint b;
        uint c;
        if (!find_corner(k, b, c))
            continue;
        radius = max(radius, max(distance(earlier_positions[b].xyz, self.earlier),
                                 distance(earlier_positions[c].xyz, self.earlier)));
        radius = max(radius, max(distance(proposed_positions[b].xyz, self.place.xyz),
                                 distance(proposed_positions[c].xyz, self.place.xyz)));
    }
    return radius;
}

void visit_collider(uint c, vec2 fabric_friction)
{
    const ColliderRecord collider = colliders[c];
    const FeatureSet set = feature_sets[c];
    if (set.features == 0 || (collider.layers & cloths[self.vertex.cloth].layers) == 0)
        return;
    collider_moves = is_moved(collider.flags);
    if (collider_moves)
    {
        pose_from = pose_at(c, push.progress_from);
        pose_to = pose_at(c, push.progress_to);
    }
    const Traveller a = traveller(self.earlier, self.place, self.velocity);
    // Most vertices are told by their own place alone that they are far from everything.
    const vec3 low = min(a.from, a.to);
    const vec3 high = max(a.from, a.to);
    const float loose = VOILE_MOST_STRETCH * set.edge + self.thickness;
    if (!boxes_overlap(low - loose, high + loose, set.box_min, set.box_max))
        return;
    const float radius = min(ring_radius() + self.thickness, loose);
    if (!boxes_overlap(low - radius, high + radius, set.box_min, set.box_max))
        return;
    self.friction = vec2(pair_friction(fabric_friction.x, collider.static_friction, collider.flags),
                         pair_friction(fabric_friction.y, collider.kinetic_friction, collider.flags));
    visit_box(set.first_node, set.first_feature, low - radius, high + radius);
}

void main()
{
    self.vertex = chunk_vertex(near_chunks[gl_WorkGroupID.x]);
    if (!self.vertex.exists)
        return;
    const uint i = self.vertex.index;
    const uint cloth = self.vertex.cloth;
    self.earlier = earlier_positions[i].xyz;
    self.place = proposed_positions[i];
    self.velocity = proposed_velocities[i].xyz;
    self.thickness = cloths[cloth].thickness;
    self.shift = self.change = self.slowing = vec3(0);
    self.pressed = 0;
    self.meets = false;
    if (self.place.w > 0)
    {
        const vec2 friction = vec2(cloths[cloth].static_friction, cloths[cloth].kinetic_friction);
        for (uint c = 0; c < push.colliders; ++c)
            visit_collider(c, friction);
    }
    const bool verlet = (cloths[cloth].flags & VOILE_CLOTH_VERLET) != 0;
    const float drift = verlet ? push.step : 0.5 * push.step; // see contact.comp
    if (!self.meets)
        return;
    corrections[i] = FeatureCorrection(self.shift + drift * self.slowing, push.substep, self.change + self.slowing, 0);
    if (verlet)
        predicted[i] += vec4(self.change + self.slowing, 0);
}
