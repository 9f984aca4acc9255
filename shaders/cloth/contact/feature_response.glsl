// The response of a vertex to the contacts of a collider's features with the pieces of cloth around it.
//
// Between two contact passes nothing holds what features push. With several substeps per pass vertices would vibrate, carry
// only a part of the load, and slide. So a pass also finds a force, which acts in each substep until the next pass: that
// which would have done in the last interval what contact and friction did. The next pass corrects the difference.
//
// The including kernel includes piece_contact.glsl and feature_force.glsl before.
#ifndef VOILE_FEATURE_RESPONSE_GLSL
#define VOILE_FEATURE_RESPONSE_GLSL

// m/s^2: a velocity below one substep of this acceleration is slow, up to twice that partly. Cloth at rest presses with
// a few times its weight.
const float k_slow = 100;
// The part of the pressure that the force supplies. With all of it, cloth would lose contact in every other pass, and friction
// with that.
const float k_lasting_pressure = 0.85;
// The same of friction, so that it ends where nothing demands it any more.
const float k_lasting_friction = 0.95;
// The part of a change of the force that a pass makes. Taut cloth vibrates, and an impact is no load.
const float k_lasting_change = 0.5;
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
    float impulses;       // the sum of the fourth powers of their impulses per mass
    FeatureMotion motion; // of the feature of the strongest
    vec3 borne;           // m/s: the sum of all impulses per mass
    vec3 force;           // m/s^2, until the next pass
};
Response no_response() { return Response(vec3(0), 0, vec3(0), k_no_collider, vec3(0), 0, k_no_motion, vec3(0), vec3(0)); }
Response response = no_response();

// The fraction that friction supplies of an impulse per mass that would stop sliding, where another one presses, both in
// m/s. The coefficient falls from static to kinetic while the demand rises. With a jump, one vertex that slips would take
// the others along, and results would depend on rounding.
float friction_fraction(float pressed, float demanded)
{
    const float slips = min(2 * max(demanded - friction.x * pressed, 0), max(demanded - friction.y * pressed, 0));
    return 1 - slips / max(demanded, 1e-30);
}

// What a contact does to the cloth there.
struct Impulse
{
    vec3 direction;   // unit, world
    float correction; // m, along it
    vec3 slowing;     // m/s, by friction
    float approach;   // m/s
};

// m/s: how much a force presses within the pass.
float pressure(vec3 force, vec3 n) { return seconds(push.substeps) * max(dot(force, n), 0); }

Impulse impulse_of(PieceContact touch)
{
    vec3 n = touch.contact.direction;
    if (collider_moves)
        n = rotate(pose_to.rotation, n);
    const float duration = seconds(push.substeps);
    const vec3 carried = carried_displacement(touch.point, touch.moved);
    // A piece that swings back within several substeps would be lifted again and again, and gain energy each time. One that
    // the force alone carries has no impulse.
    const float towards = dot(carried / duration - touch.velocity, n);
    const float impulse = touch.contact.held ? towards : max(towards, 0);
    const float approach = touch.contact.gap < self.thickness ? impulse : 0;
    // From where the cloth was to where it is. Taut cloth vibrates within a pass: its velocity says little about that, and
    // friction against a motion that is about to turn around would feed it.
    const vec3 sliding = tangential(touch.displaced - carried, n) / duration;
    // The force has supplied a part of the friction.
    const vec3 supplied = duration * tangential(touch.force, n);
    const vec3 demanded = supplied - sliding;
    const float fraction = friction_fraction(max(approach + pressure(touch.force, n), 0), length(demanded));
    return Impulse(n, touch.contact.wanted - touch.contact.gap, supplied - fraction * demanded, approach);
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
    const float pressed = max(portion * impulse.approach + pressure(self.force, n), 0);
    const float squared = pressed * pressed;
    response.slowing -= squared * pressed * portion * impulse.slowing;
    response.impulses += squared * squared;
    response.borne += pressed * n;
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

// The impulse per mass across the surface within the pass, m/s: what contacts change, and what the force has done in their
// direction.
vec3 pressing()
{
    const vec3 along = response.borne / max(length(response.borne), 1e-30);
    return response.change + pressure(self.force, along) * along;
}

// Friction with the current collider, after all contacts, and the force for the substeps until the next pass. Cloth that slides
// fast is slowed at the contact. Slow cloth is held vertex by vertex, by the impulse on each: friction at one of several
// contacts would leave the others a velocity, and cloth at rest would creep.
void add_friction()
{
    const vec3 across = pressing();
    const float found = length(across);
    if (found == 0 || response.pressed <= 0)
        return;
    const vec3 n = across / found;
    const float duration = seconds(push.substeps);
    const vec3 surface = surface_displacement(response.motion);
    const float excess = rebound(n, clamp(dot(response.change, n), 0, found), surface);
    const float pressed = found - excess;
    // That of the strongest contact. Where several are almost as strong, it is a mean of theirs.
    const vec3 slowing = pressed / found * response.pressed / max(response.impulses, 1e-37) * response.slowing;
    const vec3 v_t = tangential(self.velocity - surface / duration, n);
    const vec3 supplied = duration * tangential(self.force, n);
    const vec3 demanded = supplied - v_t;
    const float fraction = friction_fraction(pressed, length(demanded));
    const vec3 holding = fraction * demanded - supplied;
    const float most = k_slow * duration;
    const float slow = push.forces != VOILE_FORCES_NONE ? 0 : clamp(2 - max(length(v_t), pressed) / most, 0, 1);
    const float time = drift_time(is_verlet(cloths[self.vertex.cloth].flags), duration, push.kicks);
    vec3 held = time * holding;
    if (fraction == 1) // to the bit
        held = -tangential(displacement(self.earlier, self.proposed) - surface, n);
    // Shifts of other directions that move the vertex along the surface would add up to a creep, too.
    const vec3 shifted = tangential(response.shift, n);
    const float least = min(1, most * duration / max(length(shifted), 1e-30));
    response.shift += mix(time * slowing, held - fraction * least * shifted, slow);
    const vec3 rubbed = mix(slowing, holding, slow);
    response.change += rubbed - excess * n;
    if (dot(n, response.borne) > 0)
    {
        const vec3 lasting = (k_lasting_pressure * pressed * n + k_lasting_friction * (supplied + rubbed)) / duration;
        response.force = mix(self.force, lasting, k_lasting_change);
    }
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
    response.borne += other.borne;
}

#endif
