// Grab.
#include "samples/viewer/grab.hpp"

#include "samples/viewer/export_scene.hpp"

#include "voile/engine/gpu/download.hpp"
#include "voile/ranges.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace viewer
{
namespace
{

constexpr float k_radius = 0.04f; // of the cloth's size, around the picked vertex
constexpr float k_sag = 0.03f;    // of the cloth's size
constexpr float k_gravity = 9.81f;
constexpr float k_damping = 0.3f; // of sqrt(stiffness * mass)

float size_of(std::span<const glm::vec3> positions)
{
    glm::vec3 low = positions.front();
    glm::vec3 high = low;
    for (const glm::vec3& p : positions)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return std::max(glm::distance(low, high), 1e-3f);
}

float mass_of(std::span<const glm::vec4> positions)
{
    float mass = 0;
    for (const glm::vec4& p : positions)
        mass += p.w > 0 ? 1 / p.w : 0;
    return mass;
}

// The vertices around one that have no attachment yet, the vertex itself always.
std::vector<uint32_t> neighbors(std::span<const glm::vec4> positions, uint32_t vertex, float radius,
                                const std::vector<voile::Attachment>& attachments)
{
    std::set<uint32_t> attached;
    for (const voile::Attachment& attachment : attachments)
        attached.insert(attachment.vertex);
    std::vector<uint32_t> result;
    for (uint32_t i = 0; i < positions.size(); ++i)
        if (i == vertex || (positions[i].w > 0 && !attached.contains(i) &&
                            glm::distance(glm::vec3(positions[i]), glm::vec3(positions[vertex])) <= radius))
            result.push_back(i);
    return result;
}

} // namespace

Ray Grab::ray_at(const glm::vec2& cursor) const
{
    const VkExtent2D extent = app_.renderer().extent();
    return ray_through(app_.scene().camera, cursor,
                       static_cast<float>(extent.width) / static_cast<float>(extent.height));
}

std::optional<Grab::Target> Grab::pick(const Ray& ray) const
{
    const voile::Solver& solver = stage_.world->solver();
    float nearest = std::numeric_limits<float>::infinity();
    std::optional<Target> target;
    for (size_t i = 0; i < stage_.cloths.size(); ++i)
    {
        const voile::VertexStreams streams = solver.vertices(stage_.cloths[i].id);
        if (streams.vertices == 0) // not uploaded yet
            continue;
        auto positions = voile::engine::download_values<glm::vec4>(app_.device(), streams.positions, streams.offset,
                                                                   streams.vertices);
        const auto picked = pick_vertex(ray, positions, solver.triangles(stage_.cloths[i].id));
        if (!picked || picked->distance >= nearest)
            continue;
        nearest = picked->distance;
        target = Target{i, picked->vertex, std::move(positions)};
    }
    if (target && hidden(ray, nearest))
        return std::nullopt;
    return target;
}

bool Grab::hidden(const Ray& ray, float distance) const
{
    for (size_t i = 0; i < solids_.size(); ++i)
    {
        const voile::engine::Mesh mesh = mesh_of(solids_[i], 2 * app_.scene().focus_radius);
        const std::vector<glm::vec3>* deformed = stage_.motions->positions(i);
        const auto hit = hit_distance(ray, stage_.motions->pose(i) * solids_[i].transform,
                                      deformed != nullptr ? *deformed : mesh.positions, mesh.triangles);
        if (hit && *hit < distance)
            return true;
    }
    return false;
}

bool Grab::begin(const glm::vec2& cursor)
{
    end();
    const std::optional<Target> target = pick(ray_at(cursor));
    if (!target)
        return false;
    voile::Solver& solver = stage_.world->solver();
    const StageCloth& cloth = stage_.cloths[target->cloth];
    std::vector<voile::Attachment> attachments = solver.attachments(cloth.id);
    const auto attached = [&](const voile::Attachment& a) { return a.vertex == target->vertex; };
    if (std::ranges::any_of(attachments, attached))
        return false;
    point_ = target->positions[target->vertex];
    const auto anchor = solver.add_anchor(glm::translate(glm::mat4(1), point_));
    if (!anchor)
        return false;
    const float size = size_of(cloth.start);
    const float mass = mass_of(target->positions);
    const std::vector<uint32_t> vertices = neighbors(target->positions, target->vertex, k_radius * size, attachments);
    const float fraction = 1 / static_cast<float>(vertices.size());
    const float stiffness = mass * k_gravity / (k_sag * size);
    const float damping = k_damping * std::sqrt(stiffness * mass);
    for (const uint32_t vertex : vertices)
        attachments.push_back(voile::spring(vertex, std::min(fraction * stiffness, voile::k_most_attachment_stiffness),
                                            std::min(fraction * damping, voile::k_most_attachment_damping))
                                  .to(anchor.value())
                                  .at(glm::vec3(target->positions[vertex]) - point_));
    if (!solver.set_attachments(cloth.id, attachments))
    {
        voile::engine::take(solver.remove(anchor.value()));
        return false;
    }
    anchor_ = anchor.value();
    return true;
}

void Grab::move(const glm::vec2& cursor)
{
    if (!anchor_)
        return;
    point_ = point_in_plane(app_.scene().camera, ray_at(cursor), point_);
    point_ = glm::clamp(point_, -voile::k_most_coordinate, voile::k_most_coordinate);
    voile::engine::take(stage_.world->solver().move_anchor(*anchor_, glm::translate(glm::mat4(1), point_)));
}

void Grab::end()
{
    if (anchor_)
        voile::engine::take(stage_.world->solver().remove(*anchor_));
    anchor_.reset();
}

} // namespace viewer
