// The boxes of a mesh collider's hierarchy, for debug views.
#include "solver/solver_state.hpp"

namespace voile
{

namespace
{

// Appends the boxes `levels` below the node, 1 or more; `nodes` is the collider's root.
void collect(const shared::BvhNode* nodes, uint32_t node, uint32_t levels, std::vector<BoundingBox>& boxes)
{
    const shared::BvhNode& parent = nodes[node];
    const auto visit = [&](uint32_t child, const glm::vec3& min, const glm::vec3& max)
    {
        if (min.x > max.x) // of a mesh that fits one leaf, the right one
            return;
        if (levels == 1 || (child & VOILE_BVH_LEAF_BIT) != 0)
            boxes.push_back({min, max});
        else
            collect(nodes, child, levels - 1, boxes);
    };
    visit(parent.left, parent.left_min, parent.left_max);
    visit(parent.right, parent.right_min, parent.right_max);
}

// Around a box whose space is placed in the world.
BoundingBox placed(const BoundingBox& box, const glm::mat4& placement)
{
    if (placement == glm::mat4(1))
        return box;
    const glm::vec3 middle(placement * glm::vec4(0.5f * (box.min + box.max), 1));
    const glm::vec3 half = 0.5f * (box.max - box.min);
    glm::vec3 extent(0);
    for (int axis = 0; axis < 3; ++axis)
        extent += glm::abs(glm::vec3(placement[axis])) * half[axis];
    return {middle - extent, middle + extent};
}

} // namespace

std::vector<BoundingBox> Solver::hierarchy_boxes(ColliderId collider, uint32_t level) const
{
    const ColliderModel* found = state_->find(collider);
    if (found == nullptr || !found->hierarchy)
        return {};
    const ColliderModel& model = *found;
    const shared::ColliderRecord& record = model.record;
    std::vector<BoundingBox> boxes;
    if (level == 0)
        boxes.push_back({record.box_min, record.box_max});
    else
        collect(model.hierarchy->nodes.data(), 0, level, boxes);
    for (BoundingBox& box : boxes)
        box = placed({box.min + record.origin, box.max + record.origin}, model.placement);
    return boxes;
}

} // namespace voile
