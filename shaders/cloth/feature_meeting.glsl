// How a corner or an edge of a collider meets a piece of cloth, and what that changes of the vertex.
//
// The including kernel declares push.step, includes feature_pieces.glsl before, and sets `friction` and `leaving` for each
// collider.
#ifndef VOILE_FEATURE_MEETING_GLSL
#define VOILE_FEATURE_MEETING_GLSL

// Edges nearer to parallel than this sine have no direction across.
const float k_parallel = 0.03;
// A cosine: so far beyond the limit a direction must be to be inside for certain.
const float k_certain = 0.2;
// m/s, at which cloth comes away from what it is nearer to than the thickness.
const float k_recovery = 0.2;
// Barycentric coordinates this far below 0 count as inside, so that no place between two triangles is lost.
const float k_border = 1e-3;

// What meetings change of the vertex.
struct Response
{
    vec3 shift;    // m
    float pressed; // m/s, by which the meeting presses that presses most
    vec3 change;   // m/s, across surfaces
    uint meetings;
    vec3 slowing;  // m/s, by friction, of the meeting that presses most
};
Response response = Response(vec3(0), 0, vec3(0), 0, vec3(0));

// Static and kinetic coefficient of the cloth with the collider that is being looked at.
vec2 friction;
// The direction in which the cloth is brought out of that collider, in its space, of any length; 0: it is not inside.
vec3 leaving;

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

// Of the sliding velocity, what friction takes when the surfaces approached at `approach`, m/s.
float friction_share(vec2 coefficients, float approach, float speed)
{
    return speed <= coefficients.x * approach ? 1 : coefficients.y * approach / speed;
}

// A meeting at `place`. `portion`: of the vertex in what moves the cloth there; `velocity`: m/s, of the cloth there, world.
void respond(Meeting meeting, vec3 place, float portion, vec3 velocity)
{
    ++response.meetings;
    vec3 n = meeting.direction;
    vec3 relative = velocity;
    if (collider_moves)
    {
        n = rotate(pose_to.rotation, n);
        relative -= (to_world(pose_to, place) - to_world(pose_from, place)) / push.step;
    }
    // What other meetings have done in this direction is done.
    response.shift += max(portion * (meeting.wanted - meeting.gap) - dot(response.shift, n), 0) * n;
    const float approach = -min(dot(relative, n), 0);
    response.change += max(portion * approach - dot(response.change, n), 0) * n;
    if (portion * approach <= response.pressed)
        return;
    response.pressed = portion * approach;
    const vec3 sliding = relative - dot(relative, n) * n;
    response.slowing = -portion * friction_share(friction, approach, length(sliding)) * sliding;
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
    if (other.meetings == 0)
        return;
    response.meetings += other.meetings;
    response.shift = together(response.shift, other.shift);
    response.change = together(response.change, other.change);
    if (other.pressed > response.pressed)
        response.slowing = other.slowing;
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
