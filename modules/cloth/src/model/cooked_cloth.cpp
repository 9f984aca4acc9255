// Cooked cloths as bytes. Whatever is read is looked at: no index leads out of its array, no number is infinite.
#include "model/cooked_cloth.hpp"

#include "geometry/cooked_file.hpp"
#include "model/range_checks.hpp"

#include <cmath>
#include <limits>

namespace voile
{

namespace
{

constexpr float k_most = std::numeric_limits<float>::max();

// The part before the arrays.
struct Head
{
    glm::mat4 transform;
    uint64_t vertices;
    uint64_t triangles;
    uint64_t springs;
    uint64_t corners;
    uint64_t membrane; // triangles; 0: springs along the edges
    double mean_area;
    MeshTopology::Bounds fabric;
    MeshTopology::Bounds uniform;
    MeshReport report;
    uint32_t isometric;
    uint32_t uniform_masses;
};
static_assert(sizeof(MeshReport) == 32 && sizeof(Head) == 64 + 48 + 48 + 32 + 8);

bool is_finite(float value)
{
    return std::abs(value) <= k_most;
}

bool positive(double value)
{
    return value >= 0 && value <= std::numeric_limits<double>::max();
}

// Every list begins where the one before ends.
bool lists_fit(const MeshLists& lists)
{
    uint64_t springs = 0;
    uint64_t corners = 0;
    bool fit = true;
    for (const shared::MeshVertex& vertex : lists.vertices)
    {
        fit &= vertex.first_spring == springs && vertex.first_corner == corners;
        springs += vertex.springs;
        corners += vertex.corners;
    }
    return fit && springs == lists.springs.size() && corners == lists.corners.size();
}

bool membrane_fits(const MembraneTriangle& triangle, size_t vertices)
{
    bool fits = triangle.area > 0 && positive(triangle.area) && positive(triangle.weight);
    for (int i = 0; i < 3; ++i)
    {
        fits &= triangle.corner[i] < vertices;
        fits &= std::abs(triangle.position[i].x) <= 1e9 && std::abs(triangle.position[i].y) <= 1e9;
    }
    return fits;
}

// The reason why the data is none of a cloth's, or nothing.
const char* problem_of(const CookedCloth::State& state)
{
    const MeshTopology& mesh = *state.mesh;
    const size_t vertices = state.positions.size();
    const auto within = [&](uint32_t vertex) { return vertex < vertices; };
    if (!finite(state.transform) ||
        !all_of(state.positions, [](const glm::vec3& p) { return is_finite(p.x) && is_finite(p.y) && is_finite(p.z); }))
        return "a position is not finite";
    if (!all_of(mesh.triangles, [&](const glm::uvec3& t) { return within(t.x) && within(t.y) && within(t.z); }))
        return "a triangle refers to a vertex that there is not";
    if (!all_of(mesh.texture_coordinates, [](const glm::vec2& uv) { return is_finite(uv.x) && is_finite(uv.y); }))
        return "a texture coordinate is not finite";
    if (!lists_fit(mesh.lists))
        return "the lists of its vertices do not fit";
    if (!all_of(mesh.lists.springs,
                [&](const shared::MeshSpring& s)
                {
                    return within(s.neighbor & ~VOILE_OPPOSITE_BIT) && is_finite(s.rest_length) &&
                           is_finite(s.weight) && is_finite(s.bending);
                }))
        return "a spring is out of range";
    if (!all_of(mesh.lists.corners, [&](const shared::MeshCorner& c) { return within(c.b) && within(c.c); }))
        return "a corner is out of range";
    if (!all_of(mesh.lists.membrane,
                [](const shared::MembraneCorner& c)
                {
                    return c.corner < 3 && is_finite(c.weight) && is_finite(c.gradient_1.x) &&
                           is_finite(c.gradient_1.y) && is_finite(c.gradient_2.x) && is_finite(c.gradient_2.y);
                }))
        return "a corner of its membrane is out of range";
    if (!all_of(mesh.membrane, [&](const MembraneTriangle& t) { return membrane_fits(t, vertices); }))
        return "a triangle of its membrane is out of range";
    if (!all_of(mesh.areas, positive) || !positive(mesh.mean_area))
        return "an area is out of range";
    for (const MeshTopology::Bounds& bounds : {mesh.fabric, mesh.uniform})
        if (!positive(bounds.edge) || !positive(bounds.opposite) || !positive(bounds.bending))
            return "a bound is out of range";
    return nullptr;
}

} // namespace

std::vector<std::byte> CookedCloth::bytes() const
{
    if (!state_)
        return {};
    const MeshTopology& mesh = *state_->mesh;
    CookedWriter writer(CookedKind::cloth);
    writer.add(Head{state_->transform, state_->positions.size(), mesh.triangles.size(), mesh.lists.springs.size(),
                    mesh.lists.corners.size(), mesh.membrane.size(), mesh.mean_area, mesh.fabric, mesh.uniform,
                    mesh.report, mesh.isometric ? 1u : 0u, mesh.uniform_masses ? 1u : 0u});
    const auto add = [&](const auto& array) { writer.add(std::span(array)); };
    add(state_->positions);
    add(mesh.triangles);
    add(mesh.texture_coordinates);
    add(mesh.areas);
    add(mesh.lists.vertices);
    add(mesh.lists.springs);
    add(mesh.lists.corners);
    add(mesh.lists.membrane);
    add(mesh.membrane);
    return writer.finish();
}

Result<CookedCloth> CookedCloth::load(std::span<const std::byte> given, std::shared_ptr<const void> owner,
                                      const Jobs& jobs)
{
    const JobScope scope(jobs);
    const CookedBytes kept = keep_cooked(given, std::move(owner));
    auto reader = CookedReader::open(kept.bytes, CookedKind::cloth);
    if (!reader)
        return reader.error();
    const auto head = reader.value().take<Head>();
    MeshTopology mesh;
    auto state = std::make_shared<State>();
    const auto take = [&]<typename T>(SharedArray<T>& array, uint64_t count) {
        array = {reader.value().take<T>(count), kept.owner};
    };
    take(state->positions, head.vertices);
    take(mesh.triangles, head.triangles);
    take(mesh.texture_coordinates, head.vertices);
    take(mesh.areas, head.vertices);
    take(mesh.lists.vertices, head.vertices);
    take(mesh.lists.springs, head.springs);
    take(mesh.lists.corners, head.corners);
    take(mesh.lists.membrane, head.corners);
    take(mesh.membrane, head.membrane);
    if (!reader.value().ok())
        return Error{"cooked data: a cloth's arrays have other lengths than its header states"};
    if (head.vertices == 0 || head.springs == 0 || head.vertices > UINT32_MAX / 2 || head.springs > UINT32_MAX ||
        head.corners > UINT32_MAX || head.uniform_masses > 1 || head.isometric > 1 ||
        head.membrane != (head.uniform_masses != 0 ? 0 : head.corners / 3))
        return Error{"cooked data: a cloth of these sizes does not exist"};
    mesh.mean_area = head.mean_area;
    mesh.fabric = head.fabric;
    mesh.uniform = head.uniform;
    mesh.report = head.report;
    mesh.isometric = head.isometric != 0;
    mesh.uniform_masses = head.uniform_masses != 0;
    state->transform = head.transform;
    state->mesh = std::make_shared<const MeshTopology>(std::move(mesh));
    if (const char* problem = problem_of(*state))
        return Error{std::string("cooked data: ") + problem};
    return CookedCloth(std::move(state));
}

uint32_t CookedCloth::vertices() const
{
    return state_ ? static_cast<uint32_t>(state_->positions.size()) : 0;
}

uint32_t CookedCloth::triangles() const
{
    return state_ ? static_cast<uint32_t>(state_->mesh->triangles.size()) : 0;
}

} // namespace voile
