// OBJ in and out. Reading: the text is checked (obj_check), parsed (tinyobjloader), cut into triangles (triangulate),
// cleaned, and put together as one mesh.
#include "engine/assets/obj.hpp"

#include "engine/assets/file.hpp"
#include "engine/assets/obj_check.hpp"
#include "engine/assets/triangulate.hpp"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>
#include <unordered_set>

namespace engine
{

namespace
{

using Corner = tinyobj::index_t; // position, normal, texture coordinate; -1 where there is none
using Triangle = std::array<Corner, 3>;

struct Parsed
{
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> texture_coordinates;
    std::vector<Triangle> triangles;
};

std::vector<glm::vec3> triples(const std::vector<float>& numbers)
{
    std::vector<glm::vec3> vectors(numbers.size() / 3);
    for (size_t i = 0; i < vectors.size(); ++i)
        vectors[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    return vectors;
}

std::vector<glm::vec2> pairs(const std::vector<float>& numbers)
{
    std::vector<glm::vec2> vectors(numbers.size() / 2);
    for (size_t i = 0; i < vectors.size(); ++i)
        vectors[i] = {numbers[2 * i], numbers[2 * i + 1]};
    return vectors;
}

const glm::vec3& position_of(const Parsed& parsed, const Corner& corner)
{
    return parsed.positions[static_cast<size_t>(corner.vertex_index)];
}

void add_face(Parsed& parsed, std::span<const Corner> face, MeshReport& report)
{
    if (face.size() == 3)
    {
        parsed.triangles.push_back({face[0], face[1], face[2]});
        return;
    }
    ++report.polygons_triangulated;
    std::vector<glm::vec3> outline;
    outline.reserve(face.size());
    for (const Corner& corner : face)
        outline.push_back(position_of(parsed, corner));
    for (const glm::uvec3& t : triangulate(outline))
        parsed.triangles.push_back({face[t.x], face[t.y], face[t.z]});
}

gpu::Result<Parsed> parse(const CheckedObj& checked, const std::string& name, MeshReport& report)
{
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning;
    std::string error;
    std::istringstream text(checked.text);
    // Polygons stay whole: tinyobjloader cuts a concave quad along its shorter diagonal, even where that lies outside.
    const bool read =
        tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &text, nullptr, false, false);
    if (!read || shapes.size() != 1)
        return gpu::Error{name + ": cannot be parsed: " + error};

    Parsed parsed{triples(attributes.vertices), triples(attributes.normals), pairs(attributes.texcoords), {}};
    std::span<const Corner> corners = shapes.front().mesh.indices;
    parsed.triangles.reserve(corners.size() / 3);
    for (const uint32_t size : checked.face_sizes)
    {
        add_face(parsed, corners.first(size), report);
        corners = corners.subspan(size);
    }
    return parsed;
}

// For every position the first one that has the same coordinates: files repeat positions along seams.
std::vector<uint32_t> find_equal_positions(const std::vector<glm::vec3>& positions)
{
    const auto key = [&](uint32_t i) { return std::tuple(positions[i].x, positions[i].y, positions[i].z); };
    std::vector<uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    std::vector<uint32_t> first(positions.size());
    for (size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    return first;
}

// Whether floats cannot tell the triangle from a line: its height over the longest edge is within the rounding of a
// coordinate as large as the mesh's largest. A triangle may be as thin as it likes above that.
class DegenerateTest
{
public:
    explicit DegenerateTest(const std::vector<glm::vec3>& positions)
    {
        float largest = 0;
        for (const glm::vec3& p : positions)
            largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        least_height_ = std::ldexp(double{largest}, -22);
    }

    [[nodiscard]] bool operator()(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const
    {
        const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
        return glm::length(glm::cross(b - a, c - a)) <= least_height_ * longest;
    }

private:
    double least_height_;
};

struct HashIndices
{
    size_t operator()(const std::array<uint32_t, 3>& i) const
    {
        return static_cast<size_t>(
            ((i[0] * 0x9E3779B97F4A7C15u + i[1]) * 0x9E3779B97F4A7C15u + i[2]) * 0x9E3779B97F4A7C15u >> 20);
    }
};

// Drops triangles without area and those on the same three points as an earlier one, whichever way round: two faces
// back to back are of no use for collision and flicker when drawn.
void clean(Parsed& parsed, MeshReport& report)
{
    const DegenerateTest is_degenerate(parsed.positions);
    const std::vector<uint32_t> first = find_equal_positions(parsed.positions);
    std::unordered_set<std::array<uint32_t, 3>, HashIndices> seen(parsed.triangles.size());
    std::erase_if(
        parsed.triangles,
        [&](const Triangle& t)
        {
            if (is_degenerate(position_of(parsed, t[0]), position_of(parsed, t[1]), position_of(parsed, t[2])))
            {
                ++report.degenerate_triangles;
                return true;
            }
            std::array<uint32_t, 3> points;
            for (size_t i = 0; i < 3; ++i)
                points[i] = first[static_cast<size_t>(t[i].vertex_index)];
            std::sort(points.begin(), points.end());
            const bool is_new = seen.insert(points).second;
            report.duplicate_triangles += is_new ? 0 : 1;
            return !is_new;
        });
}

// One a position. Each triangle's normal counts by its angle at the corner, so that the
// result does not depend on how a flat face is cut (Thürmer and Wüthrich 1998).
std::vector<glm::vec3> compute_normals(const Parsed& parsed)
{
    std::vector<glm::dvec3> sums(parsed.positions.size(), glm::dvec3(0.));
    for (const Triangle& t : parsed.triangles)
    {
        std::array<glm::dvec3, 3> p;
        for (size_t i = 0; i < 3; ++i)
            p[i] = position_of(parsed, t[i]);
        const glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (size_t i = 0; i < 3; ++i)
        {
            const glm::dvec3 a = p[(i + 1) % 3] - p[i];
            const glm::dvec3 b = p[(i + 2) % 3] - p[i];
            const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
            sums[static_cast<size_t>(t[i].vertex_index)] += angle * normal;
        }
    }
    // Where the triangles cancel out any direction is as good.
    std::vector<glm::vec3> normals(sums.size(), glm::vec3(0.f, 1.f, 0.f));
    for (size_t i = 0; i < sums.size(); ++i)
        if (const double length = glm::length(sums[i]); length > 1e-9)
            normals[i] = sums[i] / length;
    return normals;
}

// Uses the file's normals if every corner has one that points somewhere.
void settle_normals(Parsed& parsed, MeshReport& report)
{
    const auto has_normal = [&](const Corner& c)
    { return c.normal_index >= 0 && glm::length(parsed.normals[static_cast<size_t>(c.normal_index)]) > 1e-6f; };
    report.normals_computed =
        !std::all_of(parsed.triangles.begin(), parsed.triangles.end(),
                     [&](const Triangle& t) { return std::all_of(t.begin(), t.end(), has_normal); });
    if (!report.normals_computed)
    {
        for (glm::vec3& normal : parsed.normals)
            normal = glm::length(normal) > 0 ? glm::normalize(normal) : normal;
        return;
    }
    parsed.normals = compute_normals(parsed);
    for (Triangle& t : parsed.triangles)
        for (Corner& corner : t)
            corner.normal_index = corner.vertex_index;
}

std::tuple<int, int, int> key_of(const Corner& corner)
{
    return {corner.vertex_index, corner.texcoord_index, corner.normal_index};
}

bool comes_before(const Corner& a, const Corner& b)
{
    return key_of(a) < key_of(b);
}

Mesh assemble(const Parsed& parsed)
{
    std::vector<Corner> vertices; // each combination once, in the order of the file's positions
    vertices.reserve(3 * parsed.triangles.size());
    for (const Triangle& t : parsed.triangles)
        vertices.insert(vertices.end(), t.begin(), t.end());
    std::sort(vertices.begin(), vertices.end(), comes_before);
    const auto is_equal = [](const Corner& a, const Corner& b) { return key_of(a) == key_of(b); };
    vertices.erase(std::unique(vertices.begin(), vertices.end(), is_equal), vertices.end());

    Mesh mesh;
    for (const Corner& vertex : vertices)
    {
        const int texture = vertex.texcoord_index;
        mesh.positions.push_back(position_of(parsed, vertex));
        mesh.normals.push_back(parsed.normals[static_cast<size_t>(vertex.normal_index)]);
        mesh.texture_coordinates.push_back(texture < 0 ? glm::vec2(0.f)
                                                       : parsed.texture_coordinates[static_cast<size_t>(texture)]);
    }
    const auto index_of = [&](const Corner& corner)
    {
        const auto found = std::lower_bound(vertices.begin(), vertices.end(), corner, comes_before);
        return static_cast<uint32_t>(found - vertices.begin());
    };
    for (const Triangle& t : parsed.triangles)
        mesh.triangles.emplace_back(index_of(t[0]), index_of(t[1]), index_of(t[2]));
    return mesh;
}

template <typename Number>
void append_number(std::string& text, Number number)
{
    std::array<char, 32> digits; // the shortest that read back as the same number
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text.append(" ").append(digits.data(), end);
}

} // namespace

gpu::Result<Mesh> load_obj(const std::filesystem::path& path, MeshReport* report)
{
    const std::string name = path.string();
    const gpu::Result<std::string> text = read_file(path);
    if (!text)
        return text.error();
    const gpu::Result<CheckedObj> checked = check_obj(text.value(), name);
    if (!checked)
        return checked.error();
    MeshReport changes;
    gpu::Result<Parsed> parsed = parse(checked.value(), name, changes);
    if (!parsed)
        return parsed.error();
    const size_t triangles = parsed.value().triangles.size();
    clean(parsed.value(), changes);
    if (parsed.value().triangles.empty())
        return gpu::Error{name + ": no triangles left, all " + std::to_string(triangles) + " are degenerate"};
    settle_normals(parsed.value(), changes);
    if (report != nullptr)
        *report = changes;
    return assemble(parsed.value());
}

gpu::Result<void> save_obj(const std::filesystem::path& path, const Mesh& mesh)
{
    std::string text;
    text.reserve(64 * (mesh.positions.size() + mesh.triangles.size()));
    for (size_t i = 0; i < mesh.positions.size(); ++i)
    {
        text += "v";
        for (int axis = 0; axis < 3; ++axis)
        {
            if (!std::isfinite(mesh.positions[i][axis]))
                return gpu::Error{path.string() + ": position " + std::to_string(i) + " is not finite"};
            append_number(text, mesh.positions[i][axis]);
        }
        text += "\n";
    }
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
    {
        text += "f";
        for (int corner = 0; corner < 3; ++corner)
        {
            const uint32_t index = mesh.triangles[i][corner];
            if (index >= mesh.positions.size())
                return gpu::Error{path.string() + ": triangle " + std::to_string(i) + " refers to position " +
                                  std::to_string(index) + " of " + std::to_string(mesh.positions.size())};
            append_number(text, index + 1);
        }
        text += "\n";
    }
    return write_file(path, text);
}

} // namespace engine
