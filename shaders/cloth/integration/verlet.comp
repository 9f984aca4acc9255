#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One substep of velocity Verlet (Swope et al. 1982) for the cloths that use it: kick and drift in one dispatch.
//
// The half kicks at the end of one substep and at the beginning of the next are merged: a step of n substeps is n + 1
// dispatches that kick by h/2, h, ..., h, h/2 and drift by h, ..., h, 0. Between them velocities are half a substep
// later than positions. Damping and air need velocities at the time of the positions. Each dispatch writes a prediction
// for the next (stability.h), which keeps the second order.
// One thread per vertex, or several per vertex of a mesh (mesh_forces.glsl).
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/contact_layout.h"
#include "shared/step_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 stage_positions[]; }; // w: inverse mass, 1/kg
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 stage_velocities[]; }; // predicted
layout(VOILE_BINDING(half_step_velocities)) readonly buffer HalfStepVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(next_positions)) writeonly buffer NextPositions { vec4 next_positions[]; };
layout(VOILE_BINDING(next_velocities)) writeonly buffer NextVelocities { vec4 next_velocities[]; };
layout(VOILE_BINDING(next_predicted)) writeonly buffer NextPredicted { vec4 next_predicted[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_springs)) readonly buffer MeshSprings { MeshSpring mesh_springs[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 stage_residuals[]; };
layout(VOILE_BINDING(next_residuals)) writeonly buffer NextResiduals { uvec2 next_residuals[]; };
layout(VOILE_BINDING(membrane_corners)) readonly buffer MembraneCorners { MembraneCorner membrane_corners[]; };
layout(VOILE_BINDING(contact_planes)) buffer ContactPlanes { ContactPlane planes[]; };

layout(push_constant, std430) uniform Push { StagePush push; };

#define VOILE_SHARES_FORCES
#include "forces/forces.glsl"
#include "contact/contact_vertex.glsl"
#include "integration/integrator.glsl"

float slip_time(Motion motion) { return drift_time(true, seconds(push.substeps), 1); }

#include "contact/response.glsl"

const float k_plane_slop = 1e-9; // m: rounding of slack and displacement

void stay_above(uint i, ContactPlane plane, inout Motion motion)
{
    const float h = seconds(push.substeps);
    const vec3 displacement = h * plane.velocity;
    const float slack = plane.slack + dot(motion.displacement - displacement, plane.normal);
    planes[i].slack = max(slack, 0);
    if (slack > 0)
        return;
    const vec2 friction = unpackHalf2x16(plane.friction);
    respond(motion, Surface(plane.normal, displacement, plane.velocity, k_plane_slop, Friction(friction.x, friction.y)), -slack);
}

// Contact with the surface that the vertex touched in the last contact pass.
void respond_to_plane(uint i, inout Motion motion)
{
    const ContactPlane plane = planes[i];
    if (plane.friction == VOILE_PLANE_OF_EXIT)
        leave(motion, plane.normal, plane.velocity, seconds(push.substeps));
    else if (plane.normal != vec3(0))
        stay_above(i, plane, motion);
}

void main()
{
    const PatchVertex own = patch_vertex(patch_of_batch(push.first_patch));
    if (is_idle(own))
        return;
    const PatchVertex self = force_vertex(own);
    const uint i = self.index;
    // No branch around the gather: all loads are issued together.
    const vec4 stage_x = stage_positions[i];
    const vec4 before = velocities[i];
    const FinePosition x = FinePosition(stage_x.xyz, unpack_residual(stage_residuals[i]));
    const vec3 forced = acceleration(true, self, x, stage_x.w, stage_velocities[i].xyz);
    if (!is_first(own))
        return;
    const vec3 a = stage_x.w > 0 ? forced : vec3(0);
    // A vertex that touches a collider, or hangs on a spring or a taut tether, ends the step with the velocity of that.
    // Another half kick would drive it into the surface. The next step's first kick includes that half.
    const bool ends = push.drift == 0;
    const uint touches = uint(before.w) & (VOILE_VERTEX_TOUCHES | VOILE_VERTEX_TAUT | VOILE_VERTEX_TOUCHES_FEATURE |
                                           VOILE_VERTEX_HELD | VOILE_VERTEX_BOUND);
    const float kick = touches == 0 ? seconds(push.kick) : ends ? 0 : seconds(push.substeps);
    Motion motion;
    motion.from = x;
    motion.v = before.xyz + kick * a;
    motion.displacement = seconds(push.drift) * motion.v;
    motion.cloth = self.cloth;
    if (push.planes != 0 && stage_x.w > 0)
        respond_to_plane(i, motion);
    const FinePosition next = moved(x, motion.displacement);
    next_positions[i] = vec4(next.x, stage_x.w);
    next_residuals[i] = pack_residual(next);
    next_velocities[i] = vec4(motion.v, ends ? touches : 0);
    const StabilityScales scales = scales_of(true, self.cloth, seconds(push.substeps));
    next_predicted[i] = vec4(motion.v + verlet_prediction(scales) * seconds(push.substeps) * a, 0);
}
