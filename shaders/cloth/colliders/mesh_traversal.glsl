// Traversal of the hierarchy of a mesh, rigid or deforming, with a query of type VOILE_QUERY. See bvh.glsl.
#include "colliders/bvh.glsl"
#include "colliders/padded.glsl"

void traverse(inout VOILE_QUERY query, ColliderRecord collider)
{
    if (is_deforming(collider.flags))
        traverse_padded(query, collider.first_node, collider.first_triangle, collider.triangles);
    else
        traverse_bvh(query, collider.first_node, collider.first_triangle);
}
