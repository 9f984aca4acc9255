// Attachments: the functions that make them, their validation, and their records.
#include "model/active_lists.hpp"

#include <algorithm>
#include <cmath>

namespace voile
{

namespace
{

bool is_pin(const Attachment& attachment)
{
    return attachment.stiffness == std::numeric_limits<float>::infinity();
}

Result<void> validate_attachment(const Model& model, const Attachment& attachment)
{
    const std::string what = "the attachment of vertex " + std::to_string(attachment.vertex);
    const auto bad = [&](const std::string& reason) { return Error{what + ": " + reason}; };
    if (attachment.anchor)
        if (auto exists = check_anchor(model, *attachment.anchor); !exists)
            return bad(exists.error().message);
    if (attachment.position)
    {
        if (auto valid = check(what, "position", *attachment.position, k_most_coordinate, " m"); !valid)
            return valid;
        const Anchor& anchor = *model.anchors.at(attachment.anchor ? attachment.anchor->index : 0);
        const glm::vec3 world(anchor.added * glm::vec4(*attachment.position, 1));
        if (auto valid = check(what, "position in the world", world, 2 * k_most_coordinate, " m"); !valid)
            return valid;
    }
    if (!is_pin(attachment))
        if (auto valid = check(what, {"stiffness", attachment.stiffness, 0, k_most_attachment_stiffness, " N/m"});
            !valid)
            return Error{valid.error().message + ", or infinite for a pin"};
    if (!(attachment.max_distance >= 0))
        return bad("max_distance is " + text(attachment.max_distance) + " m, must be >= 0");
    const Range ranges[] = {
        {"damping", attachment.damping, 0, k_most_attachment_damping, " N s/m"},
        {"backstop", attachment.backstop, -k_most_coordinate, k_most_coordinate, " m"},
    };
    for (const Range& range : ranges)
        if (auto valid = check(what, range); !valid)
            return valid;
    const float length = glm::length(attachment.backstop_normal);
    if (length != 0 && !(std::abs(length - 1) <= 1e-3f))
        return bad("its backstop's normal " + text(attachment.backstop_normal) + " is not of unit length");
    return {};
}

// `index`: the slot of the cloth.
shared::AttachmentRecord make_record(const Model& model, const ClothModel& cloth, uint32_t index,
                                     const Attachment& attachment)
{
    shared::AttachmentRecord record{};
    record.vertex = cloth.record.first_vertex + attachment.vertex;
    record.cloth = index;
    record.anchor = attachment.anchor ? attachment.anchor->index : 0;
    record.stiffness = is_pin(attachment) ? 0 : attachment.stiffness;
    record.damping = attachment.damping;
    record.max_distance = attachment.max_distance;
    record.normal = attachment.backstop_normal;
    record.backstop = attachment.backstop;
    if (attachment.backstop_normal != glm::vec3(0))
        record.flags |= VOILE_ATTACHMENT_BACKSTOP;
    if (attachment.position || !is_pin(attachment))
        record.flags |= VOILE_ATTACHMENT_PLACED;
    const glm::vec4 start(glm::vec3(cloth.start[attachment.vertex]), 1);
    record.position = attachment.position ? *attachment.position
                                          : glm::vec3(glm::inverse(model.anchors.at(record.anchor)->added) * start);
    return record;
}

} // namespace

Attachment Attachment::to(AnchorId frame) const
{
    Attachment result = *this;
    result.anchor = frame;
    return result;
}

Attachment Attachment::at(const glm::vec3& point) const
{
    Attachment result = *this;
    result.position = point;
    return result;
}

Attachment Attachment::with_max_distance(float distance) const
{
    Attachment result = *this;
    result.max_distance = distance;
    return result;
}

Attachment Attachment::with_backstop(const glm::vec3& normal, float distance) const
{
    Attachment result = *this;
    result.backstop_normal = normal;
    result.backstop = distance;
    return result;
}

Attachment pin(uint32_t vertex)
{
    return {.vertex = vertex};
}

Attachment pin(uint32_t vertex, AnchorId anchor)
{
    return {.vertex = vertex, .anchor = anchor};
}

Attachment pin(uint32_t vertex, AnchorId anchor, const glm::vec3& position)
{
    return {.vertex = vertex, .anchor = anchor, .position = position};
}

Attachment spring(uint32_t vertex, float stiffness, float damping)
{
    return {.vertex = vertex, .stiffness = stiffness, .damping = damping};
}

Attachment max_distance(uint32_t vertex, float distance)
{
    return {.vertex = vertex, .stiffness = 0, .max_distance = distance};
}

Attachment backstop(uint32_t vertex, const glm::vec3& normal, float distance)
{
    return {.vertex = vertex, .stiffness = 0, .backstop_normal = normal, .backstop = distance};
}

Result<void> check_anchor(const Model& model, AnchorId anchor)
{
    if (anchor.index == 0) // the world, which has no id
        return Error{"anchor 0 does not exist"};
    return model.anchors.check("anchor", anchor);
}

Result<void> validate_attachments(const Model& model, const ClothModel& cloth, std::span<const Attachment> attachments)
{
    const std::string& name = cloth.name;
    const uint32_t vertices = cloth.record.vertices;
    std::vector<bool> attached(vertices);
    for (const Attachment& attachment : attachments)
    {
        if (attachment.vertex >= vertices)
            return invalid("cloth", name,
                           "attached vertex " + std::to_string(attachment.vertex) + " of " + std::to_string(vertices));
        if (attached[attachment.vertex])
            return invalid("cloth", name, "vertex " + std::to_string(attachment.vertex) + " has two attachments");
        attached[attachment.vertex] = true;
        if (auto valid = validate_attachment(model, attachment); !valid)
            return invalid("cloth", name, valid.error().message);
    }
    return {};
}

bool has_pin(const ClothModel& cloth)
{
    return std::ranges::any_of(cloth.attachments, is_pin);
}

AttachmentCounts count_attachments(const Model& model)
{
    constexpr uint64_t k_first_ones = 16; // have room without a new buffer
    AttachmentCounts counts{.anchors = std::max(uint64_t{model.anchors.size()}, k_first_ones)};
    for (const auto [index, cloth] : model.cloths)
    {
        counts.attachments += cloth.attachments.size();
        counts.tethers += cloth.tether_options ? cloth.record.vertices : 0; // one per vertex at most, whatever its pins
    }
    counts.attachments = std::max(counts.attachments, k_first_ones);
    return counts;
}

void list_attachments(const Model& model, const LevelOf& level_of, ActiveLists& lists)
{
    lists.attachments.clear();
    lists.tethers.clear();
    const auto add = [&](const ClothModel& cloth, uint32_t index, bool pins)
    {
        for (const Attachment& attachment : cloth.attachments)
            if (is_pin(attachment) == pins)
                lists.attachments.push_back(make_record(model, cloth, index, attachment));
    };
    for (const auto [index, cloth] : model.cloths)
        if (is_active(cloth))
            add(cloth, index, true);
    const auto attachments = [&] { return static_cast<uint32_t>(lists.attachments.size()); };
    const auto tethers = [&] { return static_cast<uint32_t>(lists.tethers.size()); };
    lists.pins = attachments();
    for (uint32_t i = 0; i < VOILE_SUBSTEP_BATCHES; ++i)
    {
        BatchLists& list = lists.batches[i];
        list.attachments.first = attachments();
        list.tethers.first = tethers();
        for (const auto [index, cloth] : model.cloths)
            if (is_in_batch(cloth, batch_at(i), level_of))
            {
                add(cloth, index, false);
                lists.tethers.insert(lists.tethers.end(), cloth.tethers.begin(), cloth.tethers.end());
            }
        list.attachments.count = attachments() - list.attachments.first;
        list.tethers.count = tethers() - list.tethers.first;
    }
    lists.resting_pins.first = attachments();
    for (const auto [index, cloth] : model.cloths)
        if (cloth.uploaded && !cloth.enabled)
            add(cloth, index, true);
    lists.resting_pins.count = attachments() - lists.resting_pins.first;
}

} // namespace voile
