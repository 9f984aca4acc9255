// Holds: validation, and their records.
#include "model/model.hpp"

#include <cmath>

namespace voile
{

namespace
{

bool is_pin(const Hold& hold)
{
    return hold.stiffness == std::numeric_limits<float>::infinity();
}

Result<void> validate_hold(const Model& model, const Hold& hold)
{
    const std::string what = "the hold of vertex " + std::to_string(hold.vertex);
    const auto bad = [&](const std::string& reason) { return Error{what + ": " + reason}; };
    if (hold.anchor)
        if (auto exists = check_anchor(model, *hold.anchor); !exists)
            return bad(exists.error().message);
    if (hold.place)
    {
        if (auto valid = check(what, "place", *hold.place, k_most_coordinate, " m"); !valid)
            return valid;
        const glm::mat4& anchor = model.anchors[hold.anchor ? hold.anchor->index : 0];
        const glm::vec3 world(anchor * glm::vec4(*hold.place, 1));
        if (auto valid = check(what, "place in the world", world, 2 * k_most_coordinate, " m"); !valid)
            return valid;
    }
    if (!is_pin(hold))
        if (auto valid = check(what, {"stiffness", hold.stiffness, 0, k_most_hold_stiffness, " N/m"}); !valid)
            return Error{valid.error().message + ", or infinite for a pin"};
    if (!(hold.max_distance >= 0))
        return bad("max_distance is " + text(hold.max_distance) + " m, must be >= 0");
    const Range ranges[] = {
        {"damping", hold.damping, 0, k_most_hold_damping, " N s/m"},
        {"backstop", hold.backstop, -k_most_coordinate, k_most_coordinate, " m"},
    };
    for (const Range& range : ranges)
        if (auto valid = check(what, range); !valid)
            return valid;
    const float length = glm::length(hold.backstop_normal);
    if (length != 0 && !(std::abs(length - 1) <= 1e-3f))
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

Result<void> check_anchor(const Model& model, AnchorId anchor)
{
    if (anchor.index == 0) // the world, which has no id
        return Error{"anchor 0 does not exist"};
    return check_id("anchor", anchor.index, model.anchors.size());
}

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

} // namespace voile
