// Colliders with a formula: half space, sphere, capsule, box, each in its own space.
#ifndef VOILE_CONVEX_GLSL
#define VOILE_CONVEX_GLSL

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

ConvexSurface capsule_surface(vec3 a, vec3 b, float radius, vec3 p)
{
    const vec3 axis = b - a;
    const float t = clamp(dot(p - a, axis) / max(dot(axis, axis), 1e-30), 0, 1);
    return rounded_surface(p - a - t * axis, radius);
}

ConvexSurface box_surface(vec3 center, vec3 half_size, vec3 p)
{
    const vec3 offset = p - center;
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

// Of the kinds that have another side.
ConvexSurface convex_surface(ColliderRecord collider, vec3 p)
{
    if (collider.kind == VOILE_COLLIDER_SPHERE)
        return rounded_surface(p - collider.shape.xyz, collider.shape.w);
    if (collider.kind == VOILE_COLLIDER_CAPSULE)
        return capsule_surface(collider.shape.xyz, collider.second.xyz, collider.shape.w, p);
    return box_surface(collider.shape.xyz, collider.second.xyz, p);
}

// How many times the entry is approached, and how near counts as there, as a share of the thickness.
#define VOILE_ENTRY_STEPS 24
#define VOILE_ENTRY_NEAR 0.05

// Where a vertex that goes from `from` to `to` meets the solid, if it starts outside. Nobody is nearer to the surface than the
// distance says, so each approach goes on by that distance (Hart 1996, "Sphere tracing").
bool find_entry(ColliderRecord collider, vec3 from, vec3 to, float thickness, out vec3 entry, out ConvexSurface surface)
{
    const float way = distance(from, to);
    float gone = 0;
    entry = from;
    surface = convex_surface(collider, from);
    for (int i = 0; i < VOILE_ENTRY_STEPS && gone <= way; ++i)
    {
        if (surface.distance < VOILE_ENTRY_NEAR * thickness)
            return true;
        gone += surface.distance;
        entry = mix(from, to, gone / way);
        surface = convex_surface(collider, entry);
    }
    return false;
}

#endif
