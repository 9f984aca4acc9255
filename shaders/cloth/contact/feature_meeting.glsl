// How a corner or an edge of a collider meets a piece of cloth, and what that changes of the vertex.
//
// The including kernel includes feature_pieces.glsl and friction.glsl before, and sets `leaving` for each collider.
#ifndef VOILE_FEATURE_MEETING_GLSL
#define VOILE_FEATURE_MEETING_GLSL

// Edges nearer to parallel than this sine have no direction across.
const float k_parallel = 0.03;
// A cosine: so far beyond the limit a direction must be to be inside for certain.
const float k_certain = 0.2;
// m/s, at which cloth comes away from what it is nearer to than the thickness.
const float k_recovery = 0.2;
// m/s^2: what a substep of such an acceleration gives is slow, and up to twice as much in part. Cloth that rests presses with
// some times its weight.
const float k_slow = 100;
// Barycentric coordinates this far below 0 count as inside, so that no place between two triangles is lost.
const float k_border = 1e-3;

// No meeting.
const uint k_no_collider = 0xffffffffu;

// What meetings change of the vertex.
struct Response
{
    vec3 shift;    // m
    float pressed; // m/s, by which the meeting presses that presses most
    vec3 change;   // m/s, across surfaces
    uint collider; // of the meeting that presses most
    vec3 slowing;  // m/s, by friction, of that meeting
};
Response response = Response(vec3(0), 0, vec3(0), k_no_collider, vec3(0));

// Static and kinetic coefficient of the cloth with the collider that is being looked at.
vec2 friction;
// The direction in which the cloth is brought out of that collider, in its space, of any length; 0: it is not inside.
vec3 leaving;

vec2 find_friction()
{
    const ColliderRecord collider = colliders[collider_index];
    const ClothRecord cloth = cloths[self.vertex.cloth];
    return vec2(pair_friction(cloth.static_friction, collider.static_friction, collider.flags),
                pair_friction(cloth.kinetic_friction, collider.kinetic_friction, collider.flags));
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

// Whether a push in this direction would keep the cloth in the collider. What is round may: nothing hooks around it.
bool holds_back(Feature feature, vec3 direction)
{
    return feature.cosine > -1 && dot(leaving, direction) < 0;
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
    if (holds_back(feature, side * now))
        return result;
    result.direction = side * now;
    result.gap = side * to - feature.radius;
    const bool passed = gap_before > 0 && result.gap < 0;
    result.found = result.gap < self.thickness && (passed || result.gap > -self.thickness);
    // What is too near already comes away slowly, or one contact's push would be the next one's miss.
    result.wanted = min(self.thickness, gap_before + k_recovery * push.step);
    result.time = passed ? gap_before / (gap_before - result.gap) : 1;
    return result;
}

// The fraction that friction takes of the sliding velocity at a contact whose surfaces approach at `approach`, m/s.
float friction_fraction(float approach, float speed)
{
    return speed <= friction.x * approach ? 1 : friction.y * approach / speed;
}

// The same of a vertex that is pressed with so much impulse per mass, m/s. The coefficient falls from the static to the
// kinetic one while the speed rises. With a jump, one vertex that slips would take the others along.
float holding_fraction(float pressed, float speed)
{
    const float slips = min(2 * max(speed - friction.x * pressed, 0), max(speed - friction.y * pressed, 0));
    return 1 - slips / max(speed, 1e-30);
}

// What of a vector lies across a unit vector.
vec3 tangential(vec3 v, vec3 n) { return v - dot(v, n) * n; }

// A meeting at `place`. `portion`: of the vertex in what moves the cloth there; `velocity`: m/s, of the cloth there, world.
void respond(Meeting meeting, vec3 place, float portion, vec3 velocity)
{
    vec3 n = meeting.direction;
    vec3 relative = velocity;
    if (collider_moves)
    {
        n = rotate(pose_to.rotation, n);
        relative -= displacement(pose_from, change_of_pose, place) / push.step;
    }
    // What other meetings have done in this direction is done.
    response.shift += max(portion * (meeting.wanted - meeting.gap) - dot(response.shift, n), 0) * n;
    const float approach = -min(dot(relative, n), 0);
    response.change += max(portion * approach - dot(response.change, n), 0) * n;
    if (response.collider != k_no_collider && portion * approach <= response.pressed)
        return;
    response.pressed = portion * approach;
    response.collider = collider_index;
    const vec3 sliding = tangential(relative, n);
    response.slowing = -portion * friction_fraction(approach, length(sliding)) * sliding;
}

// Friction with the collider that is being looked at, after all meetings. Cloth that slides fast is slowed where it meets the
// collider. What is slow is held vertex by vertex, by what presses each: of several meetings of a vertex, friction at one
// leaves the others a velocity, and cloth at rest would creep by it.
void add_friction()
{
    const float pressed = length(response.change);
    if (pressed == 0)
        return;
    const vec3 n = response.change / pressed;
    const vec3 surface = surface_displacement();
    const vec3 v_t = tangential(self.velocity - surface / push.step, n);
    const float speed = length(v_t);
    const float fraction = holding_fraction(pressed, speed);
    const float most = k_slow * push.step;
    const float slow = clamp(2 - max(speed, pressed) / most, 0, 1);
    const float time = drift_time(is_verlet(cloths[self.vertex.cloth].flags), push.step);
    vec3 slid = fraction * time * v_t;
    if (fraction == 1) // to the bit
        slid = tangential(displacement(self.earlier, self.place) - surface, n);
    // What shifts of other directions move along the surface adds up to a creep, too.
    const vec3 shifted = tangential(response.shift, n);
    const float least = min(1, most * push.step / max(length(shifted), 1e-30));
    response.shift += mix(time * response.slowing, -slid - fraction * least * shifted, slow);
    response.change += mix(response.slowing, -fraction * v_t, slow);
}

// Of two changes the larger, and of the other one what that does not do in its direction.
vec3 together(vec3 one, vec3 other)
{
    const bool first = dot(one, one) >= dot(other, other);
    const vec3 larger = first ? one : other;
    const vec3 smaller = first ? other : one;
    const float size = length(smaller);
    const vec3 direction = smaller / max(size, 1e-30);
    return larger + max(size - dot(larger, direction), 0) * direction;
}

// Adds what another thread has found around the same vertex.
void merge(Response other)
{
    if (other.collider == k_no_collider)
        return;
    response.shift = together(response.shift, other.shift);
    response.change = together(response.change, other.change);
    if (response.collider == k_no_collider || other.pressed > response.pressed)
    {
        response.collider = other.collider;
        response.slowing = other.slowing;
    }
    response.pressed = max(response.pressed, other.pressed);
}

// By how much the vertex moves for what the place moves.
float portion_of(vec3 weights, vec3 inverse_masses)
{
    return inverse_masses.x * weights.x / dot(inverse_masses, weights * weights);
}

// A corner and the triangle.
void meet_triangle(Feature feature)
{
    const Traveller a = piece.a;
    const Traveller b = piece.b;
    const Traveller c = piece.c;
    const Meeting meeting = meet(feature, piece.across_then, dot(piece.across_then, a.from - feature.a), piece.across,
                                 dot(piece.across, a.to - feature.a));
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
    respond(meeting, feature.a, portion_of(weights, vec3(a.inverse_mass, b.inverse_mass, c.inverse_mass)),
            weights.x * a.velocity + weights.y * b.velocity + weights.z * c.velocity);
}

// An edge and that of the cloth from the vertex to b.
void meet_edge(Feature feature, Traveller b)
{
    const Traveller a = piece.a;
    const vec3 along = feature.b - feature.a;
    const vec3 ab = b.to - a.to;
    const vec3 normal = cross(ab, along);
    if (dot(normal, normal) <= k_parallel * k_parallel * dot(ab, ab) * dot(along, along))
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
    respond(meeting, feature.a + t * along, portion_of(vec3(1 - s, s, 0), vec3(a.inverse_mass, b.inverse_mass, 0)),
            mix(a.velocity, b.velocity, s));
}

void visit_feature(Feature feature)
{
    if (feature.a == feature.b)
    {
        if (piece.triangle)
            meet_triangle(feature);
        return;
    }
    if (piece.edge_b)
        meet_edge(feature, piece.b);
    if (piece.edge_c)
        meet_edge(feature, piece.c);
}

#endif
