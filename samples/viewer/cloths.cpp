// Cloths from grids and meshes, and their pins.
#include "samples/viewer/cloths.hpp"

#include "samples/viewer/materials.hpp"
#include "samples/viewer/text.hpp"

#include "voile/engine/assets/load_mesh.hpp"
#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace viewer
{
namespace
{

// A cloth before the first step.
struct Start
{
    Surface surface;
    uint32_t columns = 0; // of a grid, which pins refer to; 0: a mesh
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

uint32_t corner_vertex(const Start& start, uint32_t corner)
{
    const uint32_t row = corner < 2 ? 0 : start.rows - 1;
    const uint32_t column = corner % 2 == 0 ? 0 : start.columns - 1;
    return row * start.columns + column;
}

std::vector<uint32_t> edge_vertices(const Start& start, Edge edge)
{
    const bool along_row = edge == Edge::top || edge == Edge::bottom;
    const uint32_t count = along_row ? start.columns : start.rows;
    const uint32_t line = edge == Edge::bottom ? start.rows - 1 : edge == Edge::right ? start.columns - 1 : 0;
    std::vector<uint32_t> result;
    for (uint32_t i = 0; i < count; ++i)
        result.push_back(along_row ? line * start.columns + i : i * start.columns + line);
    return result;
}

std::vector<uint32_t> box_vertices(const Start& start, const BoxPin& box)
{
    std::vector<uint32_t> result;
    for (uint32_t i = 0; i < start.surface.positions.size(); ++i)
        if (glm::all(glm::greaterThanEqual(start.surface.positions[i], box.min)) &&
            glm::all(glm::lessThanEqual(start.surface.positions[i], box.max)))
            result.push_back(i);
    return result;
}

std::vector<uint32_t> pinned_vertices(const Start& start, const PinEntry& pin)
{
    if (const auto* corner = std::get_if<CornerPin>(&pin.at))
        return {corner_vertex(start, corner->corner)};
    if (const auto* edge = std::get_if<EdgePin>(&pin.at))
        return edge_vertices(start, edge->edge);
    if (const auto* vertex = std::get_if<VertexPin>(&pin.at))
        return {vertex->vertex};
    return box_vertices(start, std::get<BoxPin>(pin.at));
}

// What a pin of the scene does to a vertex: a pin, or a spring and a maximum distance.
voile::Attachment make_attachment(const PinEntry& entry, uint32_t vertex)
{
    voile::Attachment attachment = voile::pin(vertex);
    if (entry.stiffness || entry.max_distance)
        attachment = voile::spring(vertex, entry.stiffness.value_or(0), entry.damping);
    return entry.max_distance ? attachment.with_max_distance(*entry.max_distance) : attachment;
}

glm::vec3 placed(const Solid& solid, const voile::engine::Mesh& mesh, uint32_t vertex)
{
    return glm::vec3(solid.transform * glm::vec4(mesh.positions[vertex], 1));
}

// The triangle whose center is nearest.
glm::uvec3 nearest_triangle(const Solid& solid, const voile::engine::Mesh& mesh, const glm::vec3& point)
{
    const auto distance = [&](const glm::uvec3& t)
    {
        const glm::vec3 sum = placed(solid, mesh, t.x) + placed(solid, mesh, t.y) + placed(solid, mesh, t.z);
        return glm::distance(sum / 3.f, point);
    };
    return *std::ranges::min_element(mesh.triangles, {}, distance);
}

// The mesh collider that a pin follows; an error if it is none.
voile::Result<size_t> followed_solid(const SceneFile& scene, const std::vector<Solid>& solids, const PinEntry& pin)
{
    const std::string path = "colliders[" + std::to_string(*pin.follow) + "]";
    const auto solid = std::ranges::find_if(solids, [&](const Solid& s) { return s.location.path == path; });
    if (solid == solids.end() || !std::holds_alternative<voile::engine::Mesh>(solid->shape))
        return error_at(scene, pin.location, "follows " + path + ", which is no mesh of this run");
    return static_cast<size_t>(solid - solids.begin());
}

// What all pins of a cloth share while they are added.
struct PinContext
{
    voile::Solver& solver;
    const SceneFile& scene;
    const std::vector<Solid>& solids;
    const Start& start;
    AddedCloth& added;
};

// Binds a vertex to the nearest triangle of the collider that its pin follows.
voile::Result<voile::Attachment> follow(const PinContext& context, const PinEntry& pin, size_t number, uint32_t vertex)
{
    const Solid& solid = context.solids[number];
    const auto& mesh = std::get<voile::engine::Mesh>(solid.shape);
    const glm::vec3 position = context.start.surface.positions[vertex];
    const glm::uvec3 t = nearest_triangle(solid, mesh, position);
    const glm::mat4 frame =
        triangle_frame(placed(solid, mesh, t.x), placed(solid, mesh, t.y), placed(solid, mesh, t.z));
    const auto anchor = context.solver.add_anchor(frame);
    if (!anchor)
        return error_at(context.scene, pin.location, anchor.error().message);
    context.added.following_pins.push_back({anchor.value(), number, t, frame, pin.location});
    return make_attachment(pin, vertex).to(anchor.value()).at(glm::vec3(glm::inverse(frame) * glm::vec4(position, 1)));
}

// The attachments of all pins; where two pins name a vertex, the later one counts.
voile::Result<void> add_pins(const PinContext& context, const ClothEntry& entry)
{
    auto& [solver, scene, solids, start, added] = context;
    struct Pinned
    {
        voile::Attachment attachment;
        const PinEntry* pin;
    };
    std::map<uint32_t, Pinned> attached;
    for (const PinEntry& pin : entry.pins)
    {
        std::optional<voile::AnchorId> anchor;
        if (pin.motion)
        {
            auto id = solver.add_anchor(matrix(*pin.motion, 0));
            if (!id)
                return error_at(scene, pin.location, id.error().message);
            anchor = id.value();
            added.moving_pins.push_back({id.value(), *pin.motion, pin.location});
        }
        std::optional<size_t> followed;
        if (pin.follow)
        {
            const auto solid = followed_solid(scene, solids, pin);
            if (!solid)
                return solid.error();
            followed = solid.value();
        }
        const std::vector<uint32_t> pinned = pinned_vertices(start, pin);
        if (pinned.empty())
            return error_at(scene, pin.location,
                            "cloth " + in_quotes(entry.name) + ": no vertex lies in the pin's box");
        for (const uint32_t vertex : pinned)
        {
            if (vertex >= start.surface.positions.size())
                return error_at(scene, pin.location,
                                "cloth " + in_quotes(entry.name) + ": pin vertex:" + std::to_string(vertex) +
                                    ", but it has " + std::to_string(start.surface.positions.size()) + " vertices");
            if (followed)
            {
                const auto attachment = follow(context, pin, *followed, vertex);
                if (!attachment)
                    return attachment.error();
                attached[vertex] = {attachment.value(), &pin};
                continue;
            }
            voile::Attachment attachment = make_attachment(pin, vertex);
            if (anchor) // relative to the anchor, which is at its pose of time 0
                attachment = attachment.to(*anchor).at(
                    glm::vec3(glm::inverse(matrix(*pin.motion, 0)) * glm::vec4(start.surface.positions[vertex], 1)));
            attached[vertex] = {attachment, &pin};
        }
    }
    std::vector<voile::Attachment> attachments;
    std::map<const PinEntry*, std::vector<uint32_t>> vertices;
    for (const auto& [vertex, pinned] : attached)
    {
        attachments.push_back(pinned.attachment);
        vertices[pinned.pin].push_back(vertex);
    }
    for (const PinEntry& pin : entry.pins)
        if (pin.release_at > 0)
            added.released_pins.push_back(
                {added.id, vertices[&pin], static_cast<double>(pin.release_at), pin.location});
    if (auto set = solver.set_attachments(added.id, attachments); !set)
        return error_at(scene, entry.location, set.error().message);
    if (!entry.tethers)
        return {};
    if (auto set = solver.set_tethers(added.id, voile::Tethers{*entry.tethers}); !set)
        return error_at(scene, entry.location, set.error().message);
    return {};
}

voile::Result<voile::ClothId> add_grid(voile::Solver& solver, const SceneFile& scene, const ClothEntry& entry,
                                       const GridEntry& form, const Options& options, Start& start)
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
    grid.sleep_speed = entry.sleep_speed;
    auto material = make_cloth_material(
        scene, entry.material,
        glm::vec2(grid.width / static_cast<float>(grid.columns - 1), grid.depth / static_cast<float>(grid.rows - 1)));
    if (!material)
        return material.error();
    grid.material = material.value();
    start.surface.positions = grid_positions(grid);
    start.surface.faces = grid_faces(grid.columns, grid.rows);
    start.surface.texture_coordinates = grid_texture_coordinates(grid.columns, grid.rows);
    start.columns = grid.columns;
    start.rows = grid.rows;
    auto id = solver.add_cloth(grid);
    return id ? id : error_at(scene, entry.location, id.error().message);
}

bool has_seams(const voile::engine::Mesh& mesh)
{
    const voile::engine::TextureMap& map = mesh.texture_map;
    for (size_t i = 0; i < map.triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            if (map.coordinates[map.triangles[i][corner]] != mesh.texture_coordinates[mesh.triangles[i][corner]])
                return true;
    return false;
}

Surface mesh_surface(const voile::engine::Mesh& mesh, const glm::mat4& transform)
{
    Surface surface;
    for (const glm::vec3& p : mesh.positions)
        surface.positions.emplace_back(transform * glm::vec4(p, 1));
    surface.faces = triangle_faces(mesh.triangles);
    if (mesh.texture_map.triangles.empty())
        return surface;
    const bool seams = has_seams(mesh);
    surface.texture_coordinates = seams ? mesh.texture_map.coordinates : mesh.texture_coordinates;
    if (seams)
        surface.faces.texture_indices = triangle_faces(mesh.texture_map.triangles).indices;
    return surface;
}

// The texture coordinates in meters: scaled by one factor, so that the areas of all triangles together agree. None if
// there are seams, across which the warp would jump within a triangle.
std::vector<glm::vec2> fabric_coordinates(const Surface& surface)
{
    const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
    if (!surface.faces.texture_indices.empty() || surface.texture_coordinates.empty())
        return {};
    double area = 0;         // twice that of the surface
    double texture_area = 0; // twice that of its coordinates
    for (size_t i = 0; i < surface.faces.indices.size(); i += 3)
    {
        const uint32_t* t = &surface.faces.indices[i];
        const auto position = [&](int corner) { return glm::dvec3(surface.positions[t[corner]]); };
        const auto texture = [&](int corner) { return glm::dvec2(surface.texture_coordinates[t[corner]]); };
        area += glm::length(glm::cross(position(1) - position(0), position(2) - position(0)));
        texture_area += std::abs(cross(texture(1) - texture(0), texture(2) - texture(0)));
    }
    if (!(texture_area > 0))
        return {};
    const auto scale = static_cast<float>(std::sqrt(area / texture_area));
    std::vector<glm::vec2> coordinates;
    coordinates.reserve(surface.texture_coordinates.size());
    for (const glm::vec2& uv : surface.texture_coordinates)
        coordinates.push_back(scale * uv);
    return coordinates;
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
                                       const std::filesystem::path& file, Start& start)
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
    cloth.sleep_speed = entry.sleep_speed;
    cloth.material = material.value();
    start.surface = mesh_surface(mesh, cloth.transform);
    const std::vector<glm::vec2> coordinates = fabric_coordinates(start.surface);
    cloth.texture_coordinates = coordinates;
    auto id = solver.add_cloth(cloth);
    if (!id)
        return error_at(scene, entry.location, voile::engine::path_text(file) + ": " + id.error().message);
    voile::MeshReport report = solver.mesh_report(id.value());
    report.degenerate_triangles += changes.degenerate_triangles;
    note_irregularities(report, entry.name);
    return id;
}

} // namespace

glm::mat4 triangle_frame(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
{
    const glm::vec3 along = glm::normalize(b - a);
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    return {glm::vec4(along, 0), glm::vec4(normal, 0), glm::vec4(glm::cross(along, normal), 0), glm::vec4(a, 1)};
}

voile::Result<AddedCloth> add_cloth(voile::Solver& solver, const SceneFile& scene, const ClothEntry& entry,
                                    const std::vector<Solid>& solids, const Options& options)
{
    Start start;
    const auto* form = std::get_if<GridEntry>(&entry.form);
    auto id = form != nullptr ? add_grid(solver, scene, entry, *form, options, start)
                              : add_mesh(solver, scene, entry, std::get<std::filesystem::path>(entry.form), start);
    if (!id)
        return id.error();
    AddedCloth added;
    added.id = id.value();
    if (auto pins = add_pins({solver, scene, solids, start, added}, entry); !pins)
        return pins.error();
    added.surface = std::move(start.surface);
    return added;
}

} // namespace viewer
