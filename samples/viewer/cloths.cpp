// Cloths from grids and meshes, and their pins.
#include "samples/viewer/cloths.hpp"

#include "samples/viewer/materials.hpp"
#include "samples/viewer/text.hpp"

#include "voile/engine/assets/load_mesh.hpp"
#include "voile/engine/assets/words.hpp"

#include <map>
#include <utility>

namespace viewer
{
namespace
{

// What pins refer to.
struct Vertices
{
    std::vector<glm::vec3> start; // m
    uint32_t columns = 0;         // of a grid; 0: a mesh
    uint32_t rows = 0;
};

std::vector<glm::vec3> grid_positions(const voile::GridCloth& grid)
{
    std::vector<glm::vec3> positions;
    positions.reserve(size_t{grid.columns} * grid.rows);
    for (uint32_t row = 0; row < grid.rows; ++row)
        for (uint32_t column = 0; column < grid.columns; ++column)
        {
            const float x = (static_cast<float>(column) / static_cast<float>(grid.columns - 1) - 0.5f) * grid.width;
            const float z = (static_cast<float>(row) / static_cast<float>(grid.rows - 1) - 0.5f) * grid.depth;
            positions.emplace_back(grid.transform * glm::vec4(x, 0, z, 1));
        }
    return positions;
}

uint32_t corner_vertex(const Vertices& vertices, uint32_t corner)
{
    const uint32_t row = corner < 2 ? 0 : vertices.rows - 1;
    const uint32_t column = corner % 2 == 0 ? 0 : vertices.columns - 1;
    return row * vertices.columns + column;
}

std::vector<uint32_t> edge_vertices(const Vertices& vertices, Edge edge)
{
    const bool along_row = edge == Edge::top || edge == Edge::bottom;
    const uint32_t count = along_row ? vertices.columns : vertices.rows;
    const uint32_t line = edge == Edge::bottom ? vertices.rows - 1 : edge == Edge::right ? vertices.columns - 1 : 0;
    std::vector<uint32_t> result;
    for (uint32_t i = 0; i < count; ++i)
        result.push_back(along_row ? line * vertices.columns + i : i * vertices.columns + line);
    return result;
}

std::vector<uint32_t> box_vertices(const Vertices& vertices, const BoxPin& box)
{
    std::vector<uint32_t> result;
    for (uint32_t i = 0; i < vertices.start.size(); ++i)
        if (glm::all(glm::greaterThanEqual(vertices.start[i], box.min)) &&
            glm::all(glm::lessThanEqual(vertices.start[i], box.max)))
            result.push_back(i);
    return result;
}

std::vector<uint32_t> pinned_vertices(const Vertices& vertices, const PinEntry& pin)
{
    if (const auto* corner = std::get_if<CornerPin>(&pin.at))
        return {corner_vertex(vertices, corner->corner)};
    if (const auto* edge = std::get_if<EdgePin>(&pin.at))
        return edge_vertices(vertices, edge->edge);
    if (const auto* vertex = std::get_if<VertexPin>(&pin.at))
        return {vertex->vertex};
    return box_vertices(vertices, std::get<BoxPin>(pin.at));
}

// What a pin of the scene does to a vertex: a pin, or a spring and a maximum distance.
voile::Attachment make_attachment(const PinEntry& entry, uint32_t vertex)
{
    voile::Attachment attachment = voile::pin(vertex);
    if (entry.stiffness || entry.max_distance)
        attachment = voile::spring(vertex, entry.stiffness.value_or(0), entry.damping);
    return entry.max_distance ? attachment.with_max_distance(*entry.max_distance) : attachment;
}

// The attachments of all pins; where two pins name a vertex, the later one counts.
voile::Result<void> add_pins(voile::Solver& solver, const SceneFile& scene, const ClothEntry& entry,
                             const Vertices& vertices, AddedCloth& added)
{
    std::map<uint32_t, voile::Attachment> attached;
    for (const PinEntry& pin : entry.pins)
    {
        std::optional<voile::AnchorId> anchor;
        if (pin.motion)
        {
            auto id = solver.add_anchor(matrix(*pin.motion, 0));
            if (!id)
                return error_at(scene, pin.location, id.error().message);
            anchor = id.value();
            added.moving_pins.push_back({id.value(), *pin.motion});
        }
        const std::vector<uint32_t> pinned = pinned_vertices(vertices, pin);
        if (pinned.empty())
            return error_at(scene, pin.location,
                            "cloth " + in_quotes(entry.name) + ": no vertex lies in the pin's box");
        for (const uint32_t vertex : pinned)
        {
            if (vertex >= vertices.start.size())
                return error_at(scene, pin.location,
                                "cloth " + in_quotes(entry.name) + ": pin vertex:" + std::to_string(vertex) +
                                    ", but it has " + std::to_string(vertices.start.size()) + " vertices");
            voile::Attachment attachment = make_attachment(pin, vertex);
            if (anchor) // relative to the anchor, which is at its pose of time 0
                attachment = attachment.to(*anchor).at(
                    glm::vec3(glm::inverse(matrix(*pin.motion, 0)) * glm::vec4(vertices.start[vertex], 1)));
            attached[vertex] = attachment;
        }
    }
    std::vector<voile::Attachment> attachments;
    for (const auto& [vertex, attachment] : attached)
        attachments.push_back(attachment);
    if (auto set = solver.set_attachments(added.id, attachments); !set)
        return error_at(scene, entry.location, set.error().message);
    if (!entry.tethers)
        return {};
    if (auto set = solver.set_tethers(added.id, voile::Tethers{*entry.tethers}); !set)
        return error_at(scene, entry.location, set.error().message);
    return {};
}

voile::Result<voile::ClothId> add_grid(voile::Solver& solver, const SceneFile& scene, const ClothEntry& entry,
                                       const GridEntry& form, const Options& options, Vertices& vertices)
{
    voile::GridCloth grid;
    grid.name = entry.name;
    grid.columns = options.cloth_resolution.value_or(form.columns);
    grid.rows = options.cloth_resolution.value_or(form.rows);
    grid.width = form.size.x;
    grid.depth = form.size.y;
    grid.transform = matrix(entry.transform);
    grid.velocity = entry.velocity;
    grid.layers = entry.layers;
    grid.integrator = entry.integrator;
    grid.self_collision = entry.self_collision;
    auto material = make_cloth_material(
        scene, entry.material,
        glm::vec2(grid.width / static_cast<float>(grid.columns - 1), grid.depth / static_cast<float>(grid.rows - 1)));
    if (!material)
        return material.error();
    grid.material = material.value();
    vertices = {grid_positions(grid), grid.columns, grid.rows};
    auto id = solver.add_cloth(grid);
    return id ? id : error_at(scene, entry.location, id.error().message);
}

void note_irregularities(const voile::MeshReport& report, const std::string& name)
{
    std::string list;
    const auto add = [&](uint32_t count, const char* what)
    {
        if (count > 0)
            list += (list.empty() ? "" : ", ") + std::to_string(count) + " " + what;
    };
    add(report.degenerate_triangles, "triangles without area, which have no springs");
    add(report.isolated_vertices, "vertices without a triangle, which stay where they are");
    add(report.non_manifold_edges, "edges of three or more triangles, each pair of which bends");
    add(report.coincident_vertices, "vertices at the position of another and not joined to it: open seams");
    add(report.softened_edges, "edges of slivers, softer than the material so that they cost no substeps");
    if (!list.empty())
        note("cloth " + in_quotes(name) + ": " + list);
}

voile::Result<voile::ClothId> add_mesh(voile::Solver& solver, const SceneFile& scene, const ClothEntry& entry,
                                       const std::filesystem::path& file, Vertices& vertices)
{
    voile::engine::MeshReport changes;
    auto loaded = voile::engine::load_mesh(file, &changes, voile::engine::MeshVertices::positions);
    if (!loaded)
        return error_at(scene, entry.location, loaded.error().message);
    const voile::engine::Mesh& mesh = loaded.value();
    auto material = make_cloth_material(scene, entry.material, std::nullopt);
    if (!material)
        return material.error();
    voile::MeshCloth cloth;
    cloth.name = entry.name;
    cloth.positions = mesh.positions;
    cloth.triangles = mesh.triangles;
    cloth.transform = matrix(entry.transform);
    cloth.velocity = entry.velocity;
    cloth.layers = entry.layers;
    cloth.integrator = entry.integrator;
    cloth.self_collision = entry.self_collision;
    cloth.material = material.value();
    for (const glm::vec3& p : mesh.positions)
        vertices.start.emplace_back(cloth.transform * glm::vec4(p, 1));
    auto id = solver.add_cloth(cloth);
    if (!id)
        return error_at(scene, entry.location, voile::engine::path_text(file) + ": " + id.error().message);
    voile::MeshReport report = solver.mesh_report(id.value());
    report.degenerate_triangles += changes.degenerate_triangles;
    note_irregularities(report, entry.name);
    return id;
}

} // namespace

voile::Result<AddedCloth> add_cloth(voile::Solver& solver, const SceneFile& scene, const ClothEntry& entry,
                                    const Options& options)
{
    Vertices vertices;
    const auto* form = std::get_if<GridEntry>(&entry.form);
    auto id = form != nullptr ? add_grid(solver, scene, entry, *form, options, vertices)
                              : add_mesh(solver, scene, entry, std::get<std::filesystem::path>(entry.form), vertices);
    if (!id)
        return id.error();
    AddedCloth added;
    added.id = id.value();
    if (auto pins = add_pins(solver, scene, entry, vertices, added); !pins)
        return pins.error();
    added.start = std::move(vertices.start);
    return added;
}

} // namespace viewer
