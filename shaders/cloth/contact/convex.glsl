// Colliders with a formula: half space, sphere, capsule and box, in their own space. All but the half space are
// centered.
#ifndef VOILE_CONVEX_GLSL
#define VOILE_CONVEX_GLSL

bool is_convex(ColliderRecord collider)
{
    return collider.kind != VOILE_COLLIDER_MESH && collider.kind != VOILE_COLLIDER_PLANE;
}

// Whether depenetration moves vertices out of the collider. A plane has one exit: contact alone suffices.
bool is_solid(ColliderRecord collider)
{
    const uint closed = VOILE_COLLIDER_CLOSED | VOILE_COLLIDER_ONE_SIDED;
    return is_convex(collider) || (collider.kind == VOILE_COLLIDER_MESH && (collider.flags & closed) == closed);
}

// m, of the sphere around a sphere, a capsule or a box.
float bounding_radius(uint kind, vec4 shape)
{
    const float size = length(shape.xyz);
    return kind == VOILE_COLLIDER_SPHERE ? shape.w : kind == VOILE_COLLIDER_CAPSULE ? size + shape.w : size;
}

// The nearest surface seen from a point.
struct ConvexSurface
{
    float distance; // m; negative inside
    vec3 direction; // unit, outwards
};

ConvexSurface rounded_surface(vec3 offset, float radius)
{
    const float distance = length(offset);
    return ConvexSurface(distance - radius, distance > 1e-9 ? offset / distance : vec3(0, 1, 0));
}

// `end`: of the capsule's axis. The other end is opposite.
ConvexSurface capsule_surface(vec3 end, float radius, vec3 p)
{
    const float t = clamp(dot(p, end) / max(dot(end, end), 1e-30), -1, 1);
    return rounded_surface(p - t * end, radius);
}

ConvexSurface box_surface(vec3 half_size, vec3 offset)
{
    const vec3 outside = abs(offset) - half_size;
    const vec3 side = vec3(offset.x < 0 ? -1 : 1, offset.y < 0 ? -1 : 1, offset.z < 0 ? -1 : 1);
    if (any(greaterThan(outside, vec3(0))))
    {
        const vec3 beyond = max(outside, 0);
        const float distance = length(beyond);
        return ConvexSurface(distance, side * beyond / distance);
    }
    const bool x = outside.x >= outside.y && outside.x >= outside.z;
    const bool y = !x && outside.y >= outside.z;
    return ConvexSurface(max(outside.x, max(outside.y, outside.z)), side * vec3(x, y, !x && !y));
}

ConvexSurface plane_surface(ColliderRecord collider, vec3 p)
{
    return ConvexSurface(dot(collider.shape.xyz, p) - collider.shape.w, collider.shape.xyz);
}

// Of a sphere, a capsule or a box.
ConvexSurface convex_surface(ColliderRecord collider, vec3 p)
{
    if (collider.kind == VOILE_COLLIDER_SPHERE)
        return rounded_surface(p, collider.shape.w);
    if (collider.kind == VOILE_COLLIDER_CAPSULE)
        return capsule_surface(collider.shape.xyz, collider.shape.w, p);
    return box_surface(collider.shape.xyz, p);
}

// The point at which a straight path first enters a solid.
struct Entry
{
    float time;     // 0..1, along the path; 2: nowhere
    vec3 direction; // unit, outwards
};

const Entry k_no_entry = Entry(2, vec3(0));

// The time at which a path from `offset` by `span` enters a sphere, or, with both vectors projected across its axis, a
// cylinder. 0: it starts inside; 2: never. Uses the nearest point of the line, because the usual discriminant is a
// difference of large numbers where a fast path hits a small sphere.
float rounded_entry(vec3 offset, vec3 span, float radius)
{
    if (dot(offset, offset) <= radius * radius)
        return 0;
    const float length2 = max(dot(span, span), 1e-30);
    const float nearest = -dot(offset, span) / length2;
    const vec3 closest = offset + nearest * span;
    const float chord2 = radius * radius - dot(closest, closest);
    return nearest > 0 && chord2 > 0 ? max(nearest - sqrt(chord2 / length2), 0) : 2;
}

// For paths that start outside.
Entry sphere_entry(vec3 offset, vec3 span, float radius)
{
    const float time = rounded_entry(offset, span, radius);
    return time <= 1 ? Entry(time, normalize(offset + time * span)) : k_no_entry;
}

Entry capsule_entry(vec3 end, float radius, vec3 offset, vec3 span)
{
    const float size = length(end);
    const vec3 axis = end / max(size, 1e-30);
    const vec3 across = offset - dot(offset, axis) * axis;
    const vec3 span_across = span - dot(span, axis) * axis;
    const float time = rounded_entry(across, span_across, radius);
    if (time > 1)
        return k_no_entry;
    // Past an end the path can only enter through that end's half sphere.
    const float along = dot(offset + time * span, axis);
    if (abs(along) > size)
        return sphere_entry(along > 0 ? offset - end : offset + end, span, radius);
    return Entry(time, normalize(across + time * span_across));
}

Entry box_entry(vec3 half_size, vec3 offset, vec3 span)
{
    float enters = -1;
    float leaves = 1;
    vec3 direction = vec3(0);
    for (int axis = 0; axis < 3; ++axis)
    {
        const float speed = abs(span[axis]);
        const float side = span[axis] > 0 ? -1 : 1; // of the face that the path can enter
        const float before = side * offset[axis] - half_size[axis];
        if (before > 0 && before >= speed)
            return k_no_entry;
        if (before > enters * speed && before > 0)
        {
            enters = before / speed;
            direction = vec3(0);
            direction[axis] = side;
        }
        const float behind = before + 2 * half_size[axis];
        if (behind < 0)
            return k_no_entry;
        leaves = behind < leaves * speed ? behind / speed : leaves;
    }
    return enters >= 0 && enters <= leaves ? Entry(enters, direction) : k_no_entry;
}

// m: the distance from `offset` in a unit direction to the last point of a centered sphere.
float sphere_exit(vec3 offset, vec3 direction, float radius)
{
    const float nearest = -dot(offset, direction);
    const vec3 closest = offset + nearest * direction;
    return nearest + sqrt(max(radius * radius - dot(closest, closest), 0));
}

float capsule_exit(vec3 end, float radius, vec3 offset, vec3 direction)
{
    const float size = length(end);
    const vec3 axis = end / max(size, 1e-30);
    const float along = dot(offset, axis);
    const float slope = dot(direction, axis);
    const vec3 across = direction - slope * axis;
    const float speed = length(across);
    const float side = sphere_exit(offset - along * axis, across / max(speed, 1e-30), radius) / max(speed, 1e-30);
    const float leaves = along + side * slope;
    if (abs(leaves) <= size)
        return side;
    return sphere_exit(leaves < 0 ? offset + end : offset - end, direction, radius);
}

float box_exit(vec3 half_size, vec3 offset, vec3 direction)
{
    const vec3 side = vec3(direction.x < 0 ? -1 : 1, direction.y < 0 ? -1 : 1, direction.z < 0 ? -1 : 1);
    const vec3 exits = (half_size - side * offset) / max(abs(direction), vec3(1e-30));
    return min(exits.x, min(exits.y, exits.z));
}

// m: the distance from inside a solid to its surface in a unit direction.
float convex_exit(ColliderRecord collider, vec3 from, vec3 direction)
{
    if (collider.kind == VOILE_COLLIDER_SPHERE)
        return sphere_exit(from, direction, collider.shape.w);
    if (collider.kind == VOILE_COLLIDER_CAPSULE)
        return capsule_exit(collider.shape.xyz, collider.shape.w, from, direction);
    return box_exit(collider.shape.xyz, from, direction);
}

// Of a sphere, a capsule or a box, for paths that start outside.
Entry convex_entry(ColliderRecord collider, vec3 from, vec3 to)
{
    if (collider.kind == VOILE_COLLIDER_SPHERE)
        return sphere_entry(from, to - from, collider.shape.w);
    if (collider.kind == VOILE_COLLIDER_CAPSULE)
        return capsule_entry(collider.shape.xyz, collider.shape.w, from, to - from);
    return box_entry(collider.shape.xyz, from, to - from);
}

#endif
