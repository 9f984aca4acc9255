// Guards that keep fast cloth from crossing features (FeatureGuard), whatever its contacts do.
//
// Before the motion a plane separates a feature from a piece of cloth. As long as all vertices of the piece stay on
// their side of it, the piece and the feature cannot cross. The planes of a vertex are known before contact moves it.
//
// The including kernel includes feature_response.glsl before.
#ifndef VOILE_FEATURE_GUARD_GLSL
#define VOILE_FEATURE_GUARD_GLSL

#include "contact/feature_hold.glsl"
#include "shared/separation.glsl"

// A piece that moves less than this part of the thickness is slow: contact holds it.
const float k_slow_part = 0.25;
// Instead of the distance of a plane from the origin: it does not separate them within rounding, so that vertices may
// not approach along its normal.
const float k_no_room = 3e38;
// Over the thickness: pieces do not come nearer than this to a feature.
const float k_floor = 0.02;
// Over the longest edge of cloths at rest: something round with a larger radius has a core, to which pieces may come.
// Cloth sinks towards it between its vertices. If it had to stay beyond the surface, it could not slide around it.
const float k_round = 0.35;
// The radius of the core, over the radius.
const float k_core = 0.5;
// Vertices may use this part of the distance, so that something is left.
const float k_guarded_part = 0.9;

FeatureGuard guard;
vec4 urgency; // of the planes: the approach over the distance
vec4 slacks;  // m, of the planes: how far the vertex may approach them
float least_slack; // m, of all planes: how far the vertex may approach
bool is_guarded;
// A second visit of the features finds the planes of pieces that are fast or squeezed. Together with the contacts they would take too many
// registers.
bool finds_guards = false;
bool any_guarded = false; // of this thread

void clear_guard()
{
    for (uint k = 0; k < VOILE_GUARD_PLANES; ++k)
        guard.planes[k] = vec4(0);
    urgency = vec4(-3e38);
    slacks = vec4(3e38);
    guard.carried = vec3(0);
    guard.least = guard.reach = least_slack = 3e38;
    is_guarded = false;
}

// m: the longest displacement of a vertex of the current piece, relative to one that moves by `moved`.
float longest_motion(SweptVertex b, bool triangle, vec3 moved)
{
    const float longest =
        max(distance(piece.a.from + moved, piece.a.to), distance(b.from + moved, b.to));
    return triangle ? max(longest, distance(piece.c.from + moved, piece.c.to)) : longest;
}

// The same relative to all of a feature.
float longest_motion(SweptVertex b, bool triangle, SweptFeature f)
{
    const float longest = longest_motion(b, triangle, f.moved);
    return is_deforming(collider_flags) ? max(longest, longest_motion(b, triangle, moved_end(f))) : longest;
}

bool is_fast(float longest) { return longest > k_slow_part * self.thickness; }

// Whether the box of the piece's motion comes closer than the thickness. What does not is not listed in all cases
// (find_near_features.comp), and vertices stay away from it (safe_part).
bool may_meet(SweptFeature f, SweptVertex b, bool triangle)
{
    Box swept = joined(held_box(piece.a), held_box(b));
    if (triangle)
        swept = joined(swept, held_box(piece.c));
    const Box own = grown(joined(box_around(f.now.a, f.now.b), box_around(a_before(f), b_before(f))),
                          f.now.radius + self.thickness);
    return overlap(swept, own);
}

// m, from the line of a feature: where guards are. Edges at rest decide: if stretched ones did, pieces in the core
// would have no room from some stretch on.
float guarded_radius(float radius)
{
    return radius > k_round * feature_sets[collider_index].edge ? k_core * radius : radius;
}

struct GuardPlane
{
    vec4 plane; // before the motion, in the collider's space
    FeatureMotion motion;
};
const GuardPlane k_no_plane = GuardPlane(vec4(0), k_no_motion);

// The plane between a feature and the current piece; 0: none, or the piece is slow and not
// squeezed, or too far to reach the feature. Also none if the piece is behind the feature, or the cloth leaves the
// collider (feature_response.glsl).
GuardPlane guard_plane(SweptFeature f, SweptVertex b, bool triangle, bool squeezed)
{
    const Feature feature = f.now;
    const SweptVertex a = piece.a;
    const SweptVertex c = piece.c;
    const float longest = longest_motion(b, triangle, f);
    if (exits_along != vec3(0) || (!squeezed && !is_fast(longest)))
        return k_no_plane;
    if (!may_meet(f, b, triangle))
        return k_no_plane;
    vec3 x[4] = vec3[](a_before(f), a.from, b.from, c.from);
    if (!triangle)
        x = vec3[](a_before(f), b_before(f), a.from, b.from);
    const Nearest nearest = nearest_points(!triangle, x);
    if (length(nearest.apart) - feature.radius > self.thickness + longest)
        return k_no_plane;
    const vec3 n = -normalize(separating_direction(!triangle, x, nearest)); // from the feature
    if (!(dot(n, n) > 0) || is_behind(feature, n))
        return k_no_plane;
    const Separation separation = separate(!triangle, x, -n);
    // Of the feature, the first side: its border is farthest along n.
    const float border = triangle ? dot(n, x[0]) : max(dot(n, x[0]), dot(n, x[1]));
    const float radius = guarded_radius(feature.radius);
    GuardPlane result;
    result.plane = vec4(n, separation.gap > radius ? border + radius + k_floor * self.thickness : k_no_room);
    result.motion = motion_of(f);
    return result;
}

// m: the displacement that integration proposes.
vec3 proposed_displacement() { return displacement(self.earlier, self.proposed); }

// Of a plane that is not kept.
void exceed(vec4 plane, float slack)
{
    if (plane.xyz == vec3(0))
        return;
    guard.least = min(guard.least, slack);
    guard.reach = min(guard.reach, inside(plane, proposed_displacement()));
}

// `slack`: m, how far the vertex may approach the plane. The more urgent planes are first, so that the last one gives way.
void insert_plane(vec4 plane, float slack)
{
    float urgent = (slack - inside(plane, proposed_displacement())) / max(slack, 1e-9);
    [[unroll]] for (uint k = 0; k < VOILE_GUARD_PLANES; ++k)
        if (urgent > urgency[k])
        {
            const vec4 other = guard.planes[k];
            const vec2 of_other = vec2(urgency[k], slacks[k]);
            guard.planes[k] = plane;
            urgency[k] = urgent;
            slacks[k] = slack;
            plane = other;
            urgent = of_other.x;
            slack = of_other.y;
        }
    exceed(plane, slack);
}

// The nearest feature carries the vertex.
void carry(vec3 carried, float slack)
{
    is_guarded = true;
    if (slack >= least_slack)
        return;
    least_slack = slack;
    guard.carried = carried;
}

// Adds a plane in the space of the current collider.
void add_plane(GuardPlane added)
{
    const vec4 plane = added.plane;
    const SweptVertex own = swept_vertex(self.earlier, self.proposed, self.velocity, self.inverse_mass);
    if (plane.xyz == vec3(0))
        return;
    const float slack = k_guarded_part * max(dot(plane.xyz, own.from) - plane.w, 0);
    const vec3 carried = surface_displacement(added.motion);
    carry(carried, slack);
    const vec3 turned = turned_vector(added.motion, plane.xyz);
    const vec3 n = collider_moves ? rotate(pose_to.rotation, turned) : turned;
    insert_plane(vec4(n, slack - dot(n, carried)), slack);
}

// Adds the guard that another thread found for the same vertex. `other_least`: its least slack.
void merge_guard(FeatureGuard other, vec4 other_slacks, float other_least)
{
    if (other_least > 1e38)
        return;
    carry(other.carried, other_least);
    guard.least = min(guard.least, other.least);
    guard.reach = min(guard.reach, other.reach);
    for (uint k = 0; k < VOILE_GUARD_PLANES; ++k)
        if (other.planes[k].xyz != vec3(0))
            insert_plane(other.planes[k], other_slacks[k]);
}

#endif
