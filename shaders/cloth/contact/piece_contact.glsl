// Where a feature vertex or a feature edge of a collider touches a piece of cloth.
//
// The including kernel declares votes[] and includes swept_feature.glsl and friction.glsl before. It calls
// prepare_collider for each collider.
#ifndef VOILE_PIECE_CONTACT_GLSL
#define VOILE_PIECE_CONTACT_GLSL

// Edges closer to parallel than this sine have no direction across.
const float k_parallel = 0.03;
// A cosine: a direction this far beyond the limit is certainly inside.
const float k_certain = 0.2;
// m/s: the speed at which cloth closer than the thickness is lifted.
const float k_lift_speed = 0.2;
// Barycentric coordinates this far below 0 count as inside, so that no point between two triangles is missed.
const float k_border = 1e-3;
// The same for round features. Where cloth bends around one, it is nearest to the edges between triangles, and the nearest
// point of either may be beyond its border.
const float k_round_border = 0.05;
// Over the thickness: a piece this close to a feature touched it.
const float k_touching = 1.001;
// Over the thickness: a piece this close to a feature is pressed harder than its response can answer.
const float k_squeezed = 0.5;
// The most that a vertex moves per motion of the contact point. Equal masses need 1.4, a ratio of 16 needs 3.4.
const float k_most_portion = 4;

// Static and kinetic coefficient of the cloth with the current collider.
vec2 friction;
// The exit direction of the cloth from that collider, in its space, of any length. 0: it is not inside.
vec3 exits_along;

vec2 find_friction()
{
    const ColliderRecord collider = colliders[collider_index];
    const ClothRecord cloth = cloths[self.vertex.cloth];
    return vec2(pair_friction(cloth.static_friction, collider.static_friction, collider.flags),
                pair_friction(cloth.kinetic_friction, collider.kinetic_friction, collider.flags));
}

// The sum of the exit directions of the cloth's vertices, in the collider's space; 0 if none is inside it.
vec3 exit_direction(uint cloth, uint c)
{
    const uint word = VOILE_VOTE_WORDS * cloth;
    if ((votes[word + VOILE_VOTE_COLLIDERS] & (1u << (c % 32))) == 0)
        return vec3(0);
    const vec3 sum = vec3(int(votes[word + 1]), int(votes[word + 2]), int(votes[word + 3]));
    return collider_moves ? rotate_back(pose_to.rotation, sum) : sum;
}

// After select_collider.
void prepare_collider()
{
    friction = find_friction();
    exits_along = exit_direction(self.vertex.cloth, collider_index);
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
    return feature.cosine > -1 && dot(exits_along, direction) < 0;
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
    if (is_behind(feature, side * now))
    {
        if (abs(from) > self.thickness)
            return result;
        side = -side;
    }
    const float gap_before = side * from - feature.radius;
    if (holds_back(feature, side * now))
        return result;
    result.direction = side * now;
    result.gap = side * to - feature.radius;
    const bool passed = gap_before > 0 && result.gap < 0;
    const float nearest = (push.forces != VOILE_FORCES_NONE ? VOILE_CARRIED : 1) * self.thickness;
    result.found = result.gap < nearest && (passed || result.gap > -self.thickness);
    // What was too close before is lifted slowly, or one contact's push would make the next one miss.
    result.wanted = min(self.thickness, gap_before + k_lift_speed * seconds(push.substeps));
    result.squeezed = result.found && gap_before < k_squeezed * self.thickness;
    result.held = push.kicks > 1 && gap_before <= k_touching * self.thickness;
    result.time = passed ? gap_before / (gap_before - result.gap) : 1;
    return result;
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
    vec3 force;     // m/s^2
};

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
                        weights.x * a.displaced + weights.y * b.displaced + weights.z * c.displaced,
                        weights.x * a.force + weights.y * b.force + weights.z * c.force);
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
                        mix(f.moved, moved_end(f), t), mix(a.displaced, b.displaced, s), mix(a.force, b.force, s));
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
