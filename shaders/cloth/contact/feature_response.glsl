// Contact of a feature vertex or a feature edge of a collider with a piece of cloth, and its response on the vertex.
//
// The including kernel declares votes[] and includes swept_feature.glsl and friction.glsl before. It calls
// prepare_collider for each collider.
#ifndef VOILE_FEATURE_RESPONSE_GLSL
#define VOILE_FEATURE_RESPONSE_GLSL

#include "contact/limit_friction.glsl"

// Edges closer to parallel than this sine have no direction across.
const float k_parallel = 0.03;
// A cosine: a direction this far beyond the limit is inside, whatever rounding does.
const float k_certain = 0.02;
// m/s: the speed at which cloth closer than the thickness is lifted.
const float k_lift_speed = 0.2;
// m/s^2: a velocity below one substep of this acceleration is slow, up to twice that partly. Cloth at rest presses with
// a few times its weight.
const float k_slow = 100;
// Barycentric coordinates this far below 0 count as inside, so that no point between two triangles is missed.
const float k_border = 1e-3;
// The same for round features. Where cloth bends around one, it is nearest to the edges between triangles, and the nearest
// point of either may be beyond its border.
const float k_round_border = 0.05;
// Over the thickness: a piece this close to a feature touched it.
const float k_touching = 1.001;
// Over the thickness: a piece this close to a feature is pressed harder than its response can answer.
const float k_squeezed = 0.5;
// Over the thickness: cloth this far behind a feature is let out there, if the solid is deep enough. Solids that close on cloth
// leave it around their edges.
const float k_deepest = 3;
// The most that a vertex moves per motion of the contact point. Equal masses need 1.4, a ratio of 16 needs 3.4.
const float k_most_portion = 4;

// No contact.
const uint k_no_collider = 0xffffffffu;

// The response of the vertex to all contacts.
struct Response
{
    vec3 shift;    // m
    float pressed; // m/s, impulse per mass of the strongest contact
    vec3 change;   // m/s, across surfaces
    uint collider; // of the strongest contact
    vec3 slowing;  // m/s, by friction: the sum over all contacts, each times the cube of its impulse per mass
    FeatureMotion motion; // of the feature of the strongest
    float impulses;       // the sum of the fourth powers of their impulses per mass
};
Response no_response() { return Response(vec3(0), 0, vec3(0), k_no_collider, vec3(0), k_no_motion, 0); }
Response response = no_response();

// Static and kinetic coefficient of the cloth with the current collider.
vec2 friction;
// The exit direction of the cloth from that collider, in its space, of any length. 0: it is not inside, or pinched.
vec3 exits_along;
// Whether vertices of the cloth are between that collider and another one that have closed on them. Edges would hook into
// the cloth around them, and stretch it until it snaps free.
bool pinched;

vec2 find_friction()
{
    const ColliderRecord collider = colliders[collider_index];
    const ClothRecord cloth = cloths[self.vertex.cloth];
    return vec2(pair_friction(cloth.static_friction, collider.static_friction, collider.flags),
                pair_friction(cloth.kinetic_friction, collider.kinetic_friction, collider.flags));
}

void find_exits()
{
    const uint own = collider_index % VOILE_BALLOTS;
    const uint first = VOILE_VOTE_WORDS * self.vertex.cloth;
    exits_along = vec3(0);
    pinched = false;
    if (votes[first + VOILE_BALLOT_WORDS * own + VOILE_BALLOT_COLLIDER] == 0)
        return;
    vec3 sum = vec3(0);
    pinched = true;
    for (uint bits = votes[first + VOILE_BALLOT_WORDS * own + VOILE_BALLOT_TOGETHER] | 1u << own; bits != 0; bits &= bits - 1)
    {
        const uint word = first + VOILE_BALLOT_WORDS * findLSB(bits);
        sum += vec3(int(votes[word + 1]), int(votes[word + 2]), int(votes[word + 3]));
        pinched = pinched && votes[word + VOILE_BALLOT_COUNT] == 0;
    }
    exits_along = collider_moves ? rotate_back(pose_to.rotation, sum) : sum;
}

// After select_collider.
void prepare_collider()
{
    friction = find_friction();
    find_exits();
}

// The contact of a feature with a piece of cloth.
struct FeatureContact
{
    bool found;
    vec3 direction; // unit, collider's space: to the side on which the cloth belongs
    float gap;      // m, along it; negative: on the other side
    float wanted;   // m, the gap after the response
    float time;     // 0..1 of the substep, at which they touch; 1: they are close at the end
    bool held;      // they touched before, and forces have moved the cloth for several substeps
    bool squeezed;  // they were much nearer than the thickness before
};

// Whether a piece of cloth in this direction (unit) from a feature is inside the collider.
//
// A convex edge whose faces' normals lie within the angle c of its own is a wedge. A point is inside if its direction
// is farther than 90 deg + c from the normal. A line with its foot there crosses both faces if it is farther than 180
// deg - c.
bool is_behind(Feature feature, vec3 direction)
{
    const float sine = sqrt(max(1 - feature.cosine * feature.cosine, 0));
    return feature.cosine > -1 && dot(direction, feature.normal) < -min(sine, feature.cosine) - k_certain;
}

// Whether a push in this direction would keep the cloth in the collider. Round features may push: nothing hooks around
// them.
bool holds_back(Feature feature, vec3 direction)
{
    return feature.cosine > -1 && (pinched || dot(exits_along, direction) < 0);
}

// m: how far behind a feature cloth is let out. Thin solids have another side there, on which it may belong.
float deepest_behind(Feature feature)
{
    return max(self.thickness, min(feature.depth, k_deepest * self.thickness));
}

// The piece of cloth was at height `from` (m) along the unit vector `before` and is at `to` along `now`. It belongs to
// the side where it was, unless it was inside, and so close that it must have entered here.
FeatureContact feature_contact(Feature feature, vec3 before, float from, vec3 now, float to)
{
    FeatureContact result;
    result.found = false;
    result.squeezed = false;
    if (dot(before, now) <= 0)
        from = to; // it has turned over
    float side = from >= 0 ? 1 : -1;
    float deepest = self.thickness;
    if (is_behind(feature, side * now))
    {
        deepest = deepest_behind(feature);
        if (abs(from) > deepest)
            return result;
        side = -side;
    }
    const float gap_before = side * from - feature.radius;
    if (holds_back(feature, side * now))
        return result;
    result.direction = side * now;
    result.gap = side * to - feature.radius;
    const bool passed = gap_before > 0 && result.gap < 0;
    result.found = result.gap < self.thickness && (passed || result.gap > -deepest);
    // What was too close before is lifted slowly, or one contact's push would make the next one miss.
    result.wanted = min(self.thickness, gap_before + k_lift_speed * seconds(push.substeps));
    result.squeezed = result.found && gap_before < k_squeezed * self.thickness;
    result.held = push.kicks > 1 && gap_before <= k_touching * self.thickness;
    result.time = passed ? gap_before / (gap_before - result.gap) : 1;
    return result;
}

// The fraction that friction takes of a sliding velocity, where an impulse per mass presses, both in m/s. The coefficient
// falls from static to kinetic while the speed rises. With a jump, one vertex that slips would take the others along, and
// results would depend on rounding.
float friction_fraction(float pressed, float speed)
{
    return friction_fraction(pressed, speed, friction);
}

// Where a feature and a piece of cloth touch.
struct PieceContact
{
    FeatureContact contact;
    vec3 point;    // of the feature, collider's space
    vec3 weights;   // barycentric coordinates
    vec3 velocity;  // m/s, world, of the cloth there
    vec3 moved;     // m, collider's space, of the point as the collider deforms
    vec3 displaced; // m, world, of the cloth there within the pass
};

// What a contact does to the cloth there.
struct Impulse
{
    vec3 direction;   // unit, world
    float correction; // m, along it
    vec3 slowing;     // m/s, by friction
    float approach;   // m/s
};

Impulse impulse_of(PieceContact touch)
{
    vec3 n = touch.contact.direction;
    if (collider_moves)
        n = rotate(pose_to.rotation, n);
    const float duration = seconds(push.substeps);
    const vec3 carried = carried_displacement(touch.point, touch.moved);
    // A piece that swings back within several substeps would be lifted again and again, and gain energy each time.
    const float leaving = dot(touch.velocity - carried / duration, n);
    const float approach = touch.contact.held ? -leaving : max(-leaving, 0);
    // From where the cloth was to where it is. Taut cloth vibrates within a pass: its velocity says little about that, and
    // friction against a motion that is about to turn around would feed it.
    const vec3 sliding = tangential(touch.displaced - carried, n) / duration;
    return Impulse(n, touch.contact.wanted - touch.contact.gap,
                   friction_fraction(max(approach, 0), length(sliding)) * sliding, approach);
}

// Responds to a contact with collider c. `portion`: of the vertex in the motion of the cloth there; `motion`: of the
// feature.
void respond(Impulse impulse, float portion, uint c, FeatureMotion motion)
{
    const vec3 n = impulse.direction;
    // Corrections by other contacts in this direction count.
    response.shift += max(portion * impulse.correction - dot(response.shift, n), 0) * n;
    const float change = portion * impulse.approach - dot(response.change, n);
    response.change += (impulse.approach < 0 ? min(change, 0) : max(change, 0)) * n;
    const float pressed = portion * impulse.approach;
    const float squared = max(pressed, 0) * max(pressed, 0);
    response.slowing -= squared * pressed * portion * impulse.slowing;
    response.impulses += squared * squared;
    if (response.collider != k_no_collider && pressed <= response.pressed)
        return;
    response.pressed = pressed;
    response.collider = c;
    response.motion = motion;
}

// m, world: the displacement of the surface within the substep at the vertex. `motion`: of the feature there.
vec3 surface_displacement(FeatureMotion motion)
{
    if (!collider_moves && !is_deforming(collider_flags))
        return vec3(0);
    const vec3 offset = from_origin(collider_index, collider_flags, self.earlier);
    const vec3 point = collider_moves ? to_collider(pose_from, offset) : offset;
    return carried_displacement(point, motion_at(motion, point));
}

// m/s: how much of the change `pressed` along n is too much. Each contact removes the approach of its piece, and a vertex
// takes the most of what its pieces need, so that pieces which are pressed together may throw it. No vertex leaves the
// surface faster than it does within the pass.
float rebound(vec3 n, float pressed, vec3 surface)
{
    const float duration = seconds(push.substeps);
    const float moved = dot(displacement(self.earlier, self.proposed) + response.shift - surface, n);
    const float leaves = dot(self.velocity + response.change - surface / duration, n);
    return clamp(leaves - max(moved, 0) / duration, 0, pressed);
}

// Friction with the current collider, after all contacts. Cloth that slides fast is slowed at the contact. Slow cloth
// is held vertex by vertex, by the impulse on each: friction at one of several contacts would leave the others a
// velocity, and cloth at rest would creep.
void add_friction()
{
    const float found = length(response.change);
    if (found == 0 || response.pressed <= 0)
        return;
    const vec3 n = response.change / found;
    const vec3 surface = surface_displacement(response.motion);
    const float pressed = found - rebound(n, found, surface);
    // That of the strongest contact. Where several are almost as strong, it is a mean of theirs.
    const vec3 slowing = pressed / found * response.pressed / max(response.impulses, 1e-37) * response.slowing;
    const vec3 v_t = tangential(self.velocity - surface / seconds(push.substeps), n);
    const float speed = length(v_t);
    const float fraction = friction_fraction(pressed, speed);
    const float most = k_slow * seconds(push.substeps);
    const float slow = clamp(2 - max(speed, pressed) / most, 0, 1);
    const float time = drift_time(is_verlet(cloths[self.vertex.cloth].flags), seconds(push.substeps), push.kicks);
    vec3 slid = fraction * time * v_t;
    if (fraction == 1) // to the bit
        slid = tangential(displacement(self.earlier, self.proposed) - surface, n);
    // Shifts of other directions that move the vertex along the surface would add up to a creep, too.
    const vec3 shifted = tangential(response.shift, n);
    const float least = min(1, most * seconds(push.substeps) / max(length(shifted), 1e-30));
    response.shift += mix(time * slowing, -slid - fraction * least * shifted, slow);
    response.change += (pressed - found) * n + mix(slowing, -fraction * v_t, slow);
}

// The same after the strain limit, which changes positions alone.
void add_limit_friction()
{
    const float lift = length(response.shift);
    if (lift > 0)
        response.shift -= held_after_limit(displacement(self.earlier, self.proposed), response.shift / lift,
                                           k_feature_pressing * lift, friction);
}

// The larger of two changes, plus the part of the other one that it lacks in that direction.
vec3 combined(vec3 one, vec3 other)
{
    const bool first = dot(one, one) >= dot(other, other);
    const vec3 larger = first ? one : other;
    const vec3 smaller = first ? other : one;
    const float size = length(smaller);
    const vec3 direction = smaller / max(size, 1e-30);
    return larger + max(size - dot(larger, direction), 0) * direction;
}

// Merges the response that another thread found for the same vertex.
void merge(Response other)
{
    if (other.collider == k_no_collider)
        return;
    response.shift = combined(response.shift, other.shift);
    response.change = combined(response.change, other.change);
    if (response.collider == k_no_collider || other.pressed > response.pressed)
    {
        response.collider = other.collider;
        response.motion = other.motion;
    }
    response.pressed = max(response.pressed, other.pressed);
    response.slowing += other.slowing;
    response.impulses += other.impulses;
}

// The motion of the vertices per motion of the contact point. Bounded: a vertex of a millionth of its neighbors' mass
// and a thousandth of the weight would be thrown. The products of the smallest inverse masses underflow.
vec3 portions_of(vec3 weights, vec3 inverse_masses)
{
    const float sum = max(dot(inverse_masses, weights * weights), 1e-37);
    return min(inverse_masses * weights / sum, k_most_portion);
}

PieceContact no_contact()
{
    PieceContact none;
    none.contact.found = false;
    none.contact.squeezed = false;
    return none;
}

// A feature vertex and the triangle.
PieceContact triangle_contact(SweptFeature f)
{
    const Feature feature = f.now;
    const SweptVertex a = piece.a;
    const SweptVertex b = piece.b;
    const SweptVertex c = piece.c;
    const FeatureContact contact =
        feature_contact(feature, piece.across_then, dot(piece.across_then, a.from + f.moved - feature.a), piece.across,
                        dot(piece.across, a.to - feature.a));
    if (!contact.found)
        return no_contact();
    const vec3 corner = mix(a.from + f.moved, a.to, contact.time);
    const vec3 ab = mix(b.from + f.moved, b.to, contact.time) - corner;
    const vec3 ac = mix(c.from + f.moved, c.to, contact.time) - corner;
    const vec3 ap = feature.a - corner;
    const vec3 n = cross(ab, ac);
    const float area = max(dot(n, n), 1e-30);
    const float v = dot(cross(ap, ac), n) / area;
    const float w = dot(cross(ab, ap), n) / area;
    if (min(min(v, w), 1 - v - w) < (feature.radius > 0 ? -k_round_border : -k_border))
        return no_contact();
    const vec3 weights = clamp(vec3(1 - v - w, v, w), vec3(0), vec3(1));
    return PieceContact(contact, feature.a, weights,
                        weights.x * a.velocity + weights.y * b.velocity + weights.z * c.velocity, f.moved,
                        weights.x * a.displaced + weights.y * b.displaced + weights.z * c.displaced);
}

// A feature edge and the cloth's edge from a to b.
PieceContact edge_contact(SweptFeature f, SweptVertex b)
{
    const Feature feature = f.now;
    const SweptVertex a = piece.a;
    const vec3 along = feature.b - feature.a;
    const vec3 ab = b.to - a.to;
    const vec3 normal = cross(ab, along);
    if (dot(normal, normal) <= k_parallel * k_parallel * dot(ab, ab) * dot(along, along))
        return no_contact();
    const vec3 across = normalize(normal);
    const vec3 earlier = cross(b.from - a.from, f.along_before);
    // An edge that has turned over, or was parallel, has no side from before.
    const bool turned = dot(earlier, normal) <= 0;
    const vec3 across_then = turned ? across : normalize(earlier);
    const FeatureContact contact =
        feature_contact(feature, across_then, dot(across_then, a.from + f.moved - feature.a), across,
                        dot(across, a.to - feature.a));
    if (!contact.found)
        return no_contact();
    // The nearest points of two lines; Ericson 2004, Real-Time Collision Detection, 5.1.8.
    const vec3 start = mix(a.from + f.moved, a.to, contact.time);
    const vec3 u = mix(b.from + f.moved, b.to, contact.time) - start;
    const vec3 edge = f.along_before + contact.time * (along - f.along_before);
    const vec3 r = start - feature.a;
    const float uu = dot(u, u);
    const float ua = dot(u, edge);
    const float aa = dot(edge, edge);
    const float determinant = max(uu * aa - ua * ua, 1e-30);
    const float s = (ua * dot(edge, r) - aa * dot(u, r)) / determinant;
    const float t = (uu * dot(edge, r) - ua * dot(u, r)) / determinant;
    if (min(s, t) < 0 || max(s, t) > 1)
        return no_contact();
    return PieceContact(contact, feature.a + t * along, vec3(1 - s, s, 0), mix(a.velocity, b.velocity, s),
                        mix(f.moved, moved_end(f), t), mix(a.displaced, b.displaced, s));
}

vec3 triangle_portions(PieceContact touch)
{
    return portions_of(touch.weights, vec3(piece.a.inverse_mass, piece.b.inverse_mass, piece.c.inverse_mass));
}

vec3 edge_portions(PieceContact touch, SweptVertex b)
{
    return portions_of(touch.weights, vec3(piece.a.inverse_mass, b.inverse_mass, 0));
}

#endif
