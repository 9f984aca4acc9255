// Holds: validation, and their records.
#include "model.hpp"

#include <cmath>

namespace cloth
{

namespace
{

bool is_pin(const Hold& hold)
{
    return std::isinf(hold.stiffness);
}

Result<void> validate_hold(const Model& model, const Hold& hold)
{
    const auto bad = [&](const std::string& reason)
    { return Error{"the hold of vertex " + std::to_string(hold.vertex) + ": " + reason}; };
    if (hold.anchor && hold.anchor->index >= model.anchors.size())
        return bad("anchor " + std::to_string(hold.anchor->index) + " does not exist");
    if (hold.place && !finite(*hold.place))
        return bad("its place is not finite");
    if (!(hold.stiffness >= 0))
        return bad("stiffness is " + std::to_string(hold.stiffness) + " N/m, must be >= 0");
    if (!(hold.damping >= 0) || !std::isfinite(hold.damping))
        return bad("damping is " + std::to_string(hold.damping) + " N s/m, must be finite and >= 0");
    if (!(hold.max_distance >= 0))
        return bad("max_distance is " + std::to_string(hold.max_distance) + " m, must be >= 0");
    if (!finite(hold.backstop_normal) || !std::isfinite(hold.backstop))
        return bad("its backstop is not finite");
    const float length = glm::length(hold.backstop_normal);
    if (length != 0 && std::abs(length - 1) > 1e-3f)
        return bad("its backstop's normal is not of unit length");
    return {};
}

shared::HoldRecord make_record(const Model& model, uint32_t cloth, const Hold& hold)
{
    const uint32_t vertex = model.records[cloth].first_vertex + hold.vertex;
    shared::HoldRecord record{};
    record.vertex = vertex;
    record.cloth = cloth;
    record.anchor = hold.anchor ? hold.anchor->index : 0;
    record.stiffness = is_pin(hold) ? 0 : hold.stiffness;
    record.damping = hold.damping;
    record.max_distance = hold.max_distance;
    record.normal = hold.backstop_normal;
    record.backstop = hold.backstop;
    if (hold.backstop_normal != glm::vec3(0))
        record.flags |= VOILE_HOLD_BACKSTOP;
    if (hold.place || !is_pin(hold))
        record.flags |= VOILE_HOLD_PLACED;
    const glm::vec4 start(glm::vec3(model.start[vertex]), 1);
    record.place = hold.place ? *hold.place : glm::vec3(glm::inverse(model.anchors[record.anchor]) * start);
    return record;
}

} // namespace

Result<void> validate_holds(const Model& model, uint32_t cloth, std::span<const Hold> holds)
{
    const std::string& name = model.cloths[cloth].name;
    const uint32_t vertices = model.records[cloth].vertices;
    std::vector<bool> held(vertices);
    for (const Hold& hold : holds)
    {
        if (hold.vertex >= vertices)
            return invalid("cloth", name,
                           "held vertex " + std::to_string(hold.vertex) + " of " + std::to_string(vertices));
        if (held[hold.vertex])
            return invalid("cloth", name, "vertex " + std::to_string(hold.vertex) + " is held twice");
        held[hold.vertex] = true;
        if (auto valid = validate_hold(model, hold); !valid)
            return invalid("cloth", name, valid.error().message);
    }
    return {};
}

HoldLists make_hold_lists(const Model& model)
{
    HoldLists lists;
    for (const bool pins : {true, false})
    {
        for (uint32_t cloth = 0; cloth < model.cloths.size(); ++cloth)
            for (const Hold& hold : model.cloths[cloth].holds)
                if (is_pin(hold) == pins)
                    lists.holds.push_back(make_record(model, cloth, hold));
        if (pins)
            lists.pins = static_cast<uint32_t>(lists.holds.size());
    }
    for (const ClothModel& cloth : model.cloths)
        lists.tethers.insert(lists.tethers.end(), cloth.tethers.begin(), cloth.tethers.end());
    return lists;
}

} // namespace cloth
