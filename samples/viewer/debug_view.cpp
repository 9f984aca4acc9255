// Boxes, contacts, normals and intersections as lines and dots.
#include "samples/viewer/debug_view.hpp"

#include "samples/viewer/text.hpp"

#include <algorithm>

namespace viewer
{
namespace
{

constexpr glm::vec3 k_box_color{0.02f, 0.25f, 0.9f}; // linear, as all of them
constexpr glm::vec3 k_contact_color{1.f, 0.75f, 0.02f};
constexpr glm::vec3 k_intersection_color{0.95f, 0.02f, 0.1f};
constexpr glm::vec3 k_normal_color{0.1f, 0.8f, 0.25f};
constexpr float k_normal_length = 0.02f; // of the cloth's longest side
constexpr uint32_t k_touches = 1 | 4;    // in the w of a velocity, see voile::VertexStreams
constexpr uint32_t k_intersects = 1 | 2; // cloths, colliders

// The twelve edges of a box.
void add_edges(const voile::BoundingBox& box, std::vector<glm::vec4>& from, std::vector<glm::vec4>& to)
{
    const auto corner = [&](int bits)
    {
        return glm::vec4((bits & 1) != 0 ? box.max.x : box.min.x, (bits & 2) != 0 ? box.max.y : box.min.y,
                         (bits & 4) != 0 ? box.max.z : box.min.z, 0);
    };
    for (int bits = 0; bits < 8; ++bits)
        for (const int axis : {1, 2, 4})
            if ((bits & axis) == 0)
            {
                from.push_back(corner(bits));
                to.push_back(corner(bits | axis));
            }
}

float longest_side(const std::vector<glm::vec3>& positions)
{
    glm::vec3 low = positions.front();
    glm::vec3 high = low;
    for (const glm::vec3& p : positions)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low;
    return std::max({size.x, size.y, size.z});
}

void tell_no_boxes(const Solid& solid)
{
    note("collider " + in_quotes(solid.name) + " deforms: its boxes are on the GPU alone and are not drawn");
}

} // namespace

DebugView::DebugView(voile::engine::App& app, const Stage& stage, const std::vector<Solid>& solids,
                     const DebugOptions& options)
    : app_(app), stage_(stage), solids_(solids), world_(*stage.world), motions_(*stage.motions)
{
    for (const StageCloth& cloth : stage.cloths)
        cloths_.push_back({cloth.id, k_normal_length * longest_side(cloth.start)});
    set_options(options);
}

void DebugView::set_options(const DebugOptions& options)
{
    if (options.boxes != options_.boxes)
    {
        app_.finish(); // they draw the boxes
        boxes_.clear();
        for (size_t i = 0; options.boxes && i < solids_.size(); ++i)
            solids_[i].frames ? tell_no_boxes(solids_[i]) : add_boxes(i, *options.boxes);
    }
    options_ = options;
    world_.intersections = options.intersections ? voile::Intersections::counted : voile::Intersections::not_counted;
}

void DebugView::add_boxes(size_t solid, uint32_t level)
{
    std::vector<glm::vec4> from;
    std::vector<glm::vec4> to;
    for (const voile::BoundingBox& box : world_.solver().hierarchy_boxes(stage_.colliders[solid], level))
        add_edges(box, from, to);
    if (from.empty()) // no mesh
        return;
    Boxes& boxes = boxes_.emplace_back();
    boxes.solid = solid;
    boxes.from = app_.uploads().buffer("box edges, from", from, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    boxes.to = app_.uploads().buffer("box edges, to", to, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    boxes.edges = static_cast<uint32_t>(from.size());
}

void DebugView::record_draw(VkCommandBuffer cmd, voile::engine::View& view)
{
    for (const Boxes& boxes : boxes_)
        view.draw(cmd, voile::engine::Lines{.from = boxes.from.handle(),
                                            .to = boxes.to.handle(),
                                            .count = boxes.edges,
                                            .color = k_box_color,
                                            .model = motions_.pose(boxes.solid),
                                            .label = "boxes"});
    for (const Cloth& cloth : cloths_)
    {
        const voile::VertexStreams streams = world_.solver().vertices(cloth.id);
        if (options_.normals)
            view.draw(cmd, voile::engine::Lines{.from = streams.positions,
                                                .to = streams.normals,
                                                .from_offset = streams.offset,
                                                .to_offset = streams.offset,
                                                .count = streams.vertices,
                                                .length = cloth.normal_length,
                                                .width = 1.5f,
                                                .color = k_normal_color,
                                                .label = "normals"});
        if (options_.contacts)
            view.draw(cmd, voile::engine::Dots{.positions = streams.positions,
                                               .flags = streams.velocities,
                                               .position_offset = streams.offset,
                                               .flag_offset = streams.offset,
                                               .count = streams.vertices,
                                               .mask = k_touches,
                                               .color = k_contact_color,
                                               .label = "contacts"});
        if (options_.intersections)
            view.draw(cmd, voile::engine::Dots{.positions = streams.positions,
                                               .flags = streams.intersections,
                                               .flag_words = true,
                                               .position_offset = streams.offset,
                                               .flag_offset = streams.intersection_offset,
                                               .count = streams.vertices,
                                               .mask = k_intersects,
                                               .color = k_intersection_color,
                                               .label = "intersections"});
    }
}

} // namespace viewer
