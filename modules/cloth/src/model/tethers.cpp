// Tethers: the path from each vertex to the nearest pins over the cloth.
#include "model/model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace voile
{

namespace
{

// The triangles around each vertex of a cloth at rest, and the pins.
struct Surface
{
    std::vector<glm::dvec3> positions; // m
    std::vector<glm::uvec3> triangles;
    std::vector<std::vector<uint32_t>> around; // triangles, one list per vertex
    std::vector<uint32_t> pins;
};

Surface make_surface(const ClothModel& cloth)
{
    const shared::ClothRecord& record = cloth.record;
    Surface surface;
    surface.triangles = cloth_triangles(cloth);
    surface.positions.reserve(record.vertices);
    const glm::vec2 spacing = cloth.spacing;
    for (uint32_t i = 0; i < record.vertices; ++i)
    {
        // A grid may start stretched by its transform; its shape at rest is flat.
        const glm::vec3 start(cloth.start[i]);
        surface.positions.emplace_back(record.columns > 0
                                           ? glm::vec3(static_cast<float>(i % record.columns) * spacing.x,
                                                       static_cast<float>(i / record.columns) * spacing.y, 0)
                                           : start);
    }
    surface.around.resize(record.vertices);
    for (uint32_t t = 0; t < surface.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            surface.around[surface.triangles[t][corner]].push_back(t);
    for (const Attachment& attachment : cloth.attachments)
        if (std::isinf(attachment.stiffness))
            surface.pins.push_back(attachment.vertex);
    return surface;
}

struct Path
{
    double length = std::numeric_limits<double>::infinity(); // m
    uint32_t pin = 0;
};

// The path to a triangle's third corner from the paths to the two others, as if the front between them were
// straight (Kimmel and Sethian 1998, "Computing geodesic paths on manifolds"); along an edge where that would come from
// outside the triangle.
double front_length(const Surface& surface, uint32_t at, uint32_t a, double length_a, uint32_t b, double length_b)
{
    const glm::dvec3 to_a = surface.positions[a] - surface.positions[at];
    const glm::dvec3 to_b = surface.positions[b] - surface.positions[at];
    const double edge_a = glm::length(to_a);
    const double edge_b = glm::length(to_b);
    const double along_edges = std::min(length_a + edge_a, length_b + edge_b);
    // The virtual source: at distances length_a and length_b from a and b, on the far side of their edge.
    const double base = glm::distance(surface.positions[a], surface.positions[b]);
    if (base <= 0 || length_a > length_b + base || length_b > length_a + base)
        return along_edges;
    const double source_x = (length_a * length_a - length_b * length_b + base * base) / (2 * base);
    const double source_y = -std::sqrt(std::max(length_a * length_a - source_x * source_x, 0.0));
    const double x = (edge_a * edge_a - edge_b * edge_b + base * base) / (2 * base);
    const double y = std::sqrt(std::max(edge_a * edge_a - x * x, 0.0));
    // The straight path must cross the edge between a and b.
    const double crossing = y > source_y ? source_x + (x - source_x) * -source_y / (y - source_y) : -1;
    if (crossing < 0 || crossing > base)
        return along_edges;
    return std::min(along_edges, std::hypot(x - source_x, y - source_y));
}

// The shortest paths from a group of pins to every vertex.
std::vector<Path> paths_from(const Surface& surface, std::span<const uint32_t> pins)
{
    std::vector<Path> paths(surface.positions.size());
    using Entry = std::pair<double, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    const auto relax = [&](uint32_t vertex, double length, uint32_t pin)
    {
        if (length < paths[vertex].length * (1 - 1e-12))
        {
            paths[vertex] = {length, pin};
            front.emplace(length, vertex);
        }
    };
    for (const uint32_t pin : pins)
        relax(pin, 0, pin);
    while (!front.empty())
    {
        const auto [length, vertex] = front.top();
        front.pop();
        if (length > paths[vertex].length)
            continue;
        for (const uint32_t t : surface.around[vertex])
            for (int corner = 0; corner < 3; ++corner)
            {
                const uint32_t at = surface.triangles[t][corner];
                const uint32_t b = surface.triangles[t][(corner + 1) % 3];
                const uint32_t c = surface.triangles[t][(corner + 2) % 3];
                if (at == vertex)
                    continue;
                const uint32_t other = b == vertex ? c : b;
                // Paths from two pins have no common source. Then the path follows the edge, which is never too short.
                const bool same_pin = std::isfinite(paths[other].length) && paths[other].pin == paths[vertex].pin;
                const double found = same_pin
                                         ? front_length(surface, at, vertex, length, other, paths[other].length)
                                         : length + glm::distance(surface.positions[at], surface.positions[vertex]);
                relax(at, found, paths[vertex].pin);
            }
    }
    return paths;
}

// Groups of pins that are connected by edges, the largest first.
std::vector<std::vector<uint32_t>> pin_groups(const Surface& surface)
{
    std::vector<bool> waiting(surface.positions.size());
    for (const uint32_t pin : surface.pins)
        waiting[pin] = true;
    std::vector<std::vector<uint32_t>> groups;
    for (const uint32_t pin : surface.pins)
    {
        if (!waiting[pin])
            continue;
        std::vector<uint32_t>& group = groups.emplace_back();
        group.push_back(pin);
        waiting[pin] = false;
        for (size_t next = 0; next < group.size(); ++next)
            for (const uint32_t t : surface.around[group[next]])
                for (int corner = 0; corner < 3; ++corner)
                    if (const uint32_t other = surface.triangles[t][corner]; waiting[other])
                    {
                        waiting[other] = false;
                        group.push_back(other);
                    }
    }
    std::stable_sort(groups.begin(), groups.end(), [](const auto& l, const auto& r) { return l.size() > r.size(); });
    return groups;
}

// Adds a tether to the vertex's record, in place of its longest one if it has as many as it can.
void add_tether(shared::TetherRecord& record, uint32_t pin, float length)
{
    uint32_t slot = record.count;
    if (slot < VOILE_TETHERS)
        ++record.count;
    else
    {
        slot = static_cast<uint32_t>(std::max_element(record.lengths, record.lengths + VOILE_TETHERS) - record.lengths);
        if (record.lengths[slot] <= length)
            return;
    }
    record.pins[slot] = pin;
    record.lengths[slot] = length;
}

} // namespace

Result<std::vector<shared::TetherRecord>> make_tethers(const ClothModel& cloth, uint32_t index, const Tethers& tethers)
{
    const std::string& name = cloth.name;
    if (!(tethers.stretch >= 0 && tethers.stretch <= 10))
        return invalid("cloth", name,
                       "the tethers' stretch is " + std::to_string(tethers.stretch) + ", must be 0 to 10");
    const Surface surface = make_surface(cloth);
    const uint32_t first = cloth.record.first_vertex;
    std::vector<shared::TetherRecord> records(surface.positions.size());
    for (const std::vector<uint32_t>& group : pin_groups(surface))
    {
        const std::vector<Path> paths = paths_from(surface, group);
        for (uint32_t i = 0; i < paths.size(); ++i)
        {
            if (!std::isfinite(paths[i].length) || paths[i].length == 0)
                continue;
            add_tether(records[i], first + paths[i].pin, static_cast<float>(paths[i].length) * (1 + tethers.stretch));
        }
    }
    for (uint32_t i = 0; i < records.size(); ++i)
    {
        records[i].vertex = first + i;
        records[i].cloth = index;
    }
    for (const uint32_t pin : surface.pins) // whatever other group it could hang from
        records[pin].count = 0;
    std::erase_if(records, [](const shared::TetherRecord& record) { return record.count == 0; });
    return records;
}

} // namespace voile
