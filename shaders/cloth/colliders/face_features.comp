#version 460
#extension GL_GOOGLE_include_directive : require
// Finds which edges and vertices of a deforming mesh can protrude between the vertices of a cloth, and which way they
// face. One thread per feature, over the triangles at the edges around it.
//
// A chord of the cloth's edge L sinks towards a crease of the angle t by L / 2 tan(t / 2). Where creases follow each
// other at a distance d < L, the surface has the curvature t / d, and the chord sinks by t L^2 / (8 d), which is
// L / (2 d) times as much.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/feature_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(feature_sources)) readonly buffer FeatureSources { FeatureSource feature_sources[]; };
layout(VOILE_BINDING(feature_hinges)) readonly buffer FeatureHinges { FeatureHinge feature_hinges[]; };
layout(VOILE_BINDING(deforming_positions)) readonly buffer DeformingPositions { vec4 deforming_positions[]; };
layout(VOILE_BINDING(feature_facings)) writeonly buffer FeatureFacings { FeatureFacing feature_facings[]; };

layout(push_constant, std430) uniform Push { FaceFeaturesPush push; };

// rad; an edge that turns by less is no feature.
const float k_flat = 0.035;

vec3 position(uint vertex) { return deforming_positions[push.first_vertex + vertex].xyz; }

struct HingeShape
{
    vec3 first; // unit normals of its triangles
    vec3 second;
    float sag; // m: by how much a chord sinks towards it, if it bends outwards; of a border without bounds
};

HingeShape hinge_shape(FeatureHinge hinge)
{
    const vec3 a = position(hinge.a);
    const vec3 along = position(hinge.b) - a;
    const vec3 first = cross(along, position(hinge.c) - a);
    const float first_area = length(first);
    HingeShape result;
    result.first = result.second = first / max(first_area, 1e-30);
    result.sag = 1e30;
    if (hinge.d == VOILE_NO_VERTEX)
        return result;
    const vec3 to_d = position(hinge.d) - a;
    const vec3 second = cross(to_d, along);
    const float second_area = length(second);
    result.second = second / max(second_area, 1e-30);
    const float turn = acos(clamp(dot(result.first, result.second), -1, 1));
    const bool convex = dot(result.first, to_d) < 0;
    // A triangle's center lies at a third of its height.
    const float apart = (first_area + second_area) / (3 * max(length(along), 1e-30));
    const bool bends = (convex || push.two_sided != 0) && turn >= k_flat;
    result.sag = bends ? push.edge / 2 * tan(min(turn / 2, 1.5)) * max(1, push.edge / max(2 * apart, 1e-6)) : 0;
    return result;
}

float largest_sag(FeatureSource source)
{
    float sag = 0;
    for (uint h = source.first_hinge; h < source.first_hinge + source.hinges; ++h)
        sag = max(sag, hinge_shape(feature_hinges[h]).sag);
    return sag;
}

// Whether cloth sinks too far without it. Features that are closer to each other than `spacing` hold the cloth between
// them (FeatureScale::spacing_for).
bool counts(FeatureSource source, float sag)
{
    if (sag < push.sag)
        return false;
    const float spacing = push.edge * push.sag / sag;
    if (source.a != source.b && distance(position(source.a), position(source.b)) < spacing)
        return false;
    return spacing < source.reach || largest_sag(feature_sources[source.stand_in]) < push.sag;
}

// rad: of the triangle (a, b, c) at b.
float angle_at(vec3 a, vec3 b, vec3 c)
{
    const vec3 to_a = a - b;
    const vec3 to_c = c - b;
    return acos(clamp(dot(to_a, to_c) * inversesqrt(max(dot(to_a, to_a) * dot(to_c, to_c), 1e-30)), -1, 1));
}

// The normals by angle: Thürmer and Wüthrich 1998, "Computing vertex normals from polygonal facets". Every triangle around
// a vertex is at two hinges. Those of an edge have the same weight, and so have those that do not touch the vertex.
vec3 weighted_normals(FeatureSource source, FeatureHinge hinge, HingeShape shape)
{
    if (source.a == source.b && (hinge.a == source.a || hinge.b == source.a) && hinge.d != VOILE_NO_VERTEX)
    {
        const vec3 vertex = position(source.a);
        const vec3 other = position(hinge.a == source.a ? hinge.b : hinge.a);
        return angle_at(other, vertex, position(hinge.c)) * shape.first +
               angle_at(other, vertex, position(hinge.d)) * shape.second;
    }
    return shape.first + shape.second;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.features)
        return;
    const FeatureSource source = feature_sources[push.first_feature + i];
    vec3 sum = vec3(0);
    float sag = 0;
    bool border = false;
    for (uint h = source.first_hinge; h < source.first_hinge + source.hinges; ++h)
    {
        const HingeShape shape = hinge_shape(feature_hinges[h]);
        sum += weighted_normals(source, feature_hinges[h], shape);
        sag = max(sag, shape.sag);
        border = border || feature_hinges[h].d == VOILE_NO_VERTEX;
    }
    const float size = length(sum);
    FeatureFacing facing = FeatureFacing(sum / max(size, 1e-30), -1);
    if (!border && push.two_sided == 0 && size > 1e-3)
    {
        facing.cosine = 1;
        for (uint h = source.first_hinge; h < source.first_hinge + source.hinges; ++h)
        {
            const HingeShape shape = hinge_shape(feature_hinges[h]);
            facing.cosine = min(facing.cosine, min(dot(facing.normal, shape.first), dot(facing.normal, shape.second)));
        }
    }
    if (facing.cosine < 0) // a saddle: no direction is certainly inside
        facing.cosine = -1;
    if (!counts(source, sag))
        facing.cosine = VOILE_NO_FACING;
    feature_facings[push.first_facing + i] = facing;
}
