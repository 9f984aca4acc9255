// Reads and writes OBJ. Reading has three steps: check (obj_check), parse (tinyobjloader), build (mesh_builder).
#include "voile/engine/assets/obj.hpp"

#include "assets/mesh_builder.hpp"
#include "assets/obj_check.hpp"
#include "voile/engine/assets/file.hpp"
#include "voile/engine/assets/words.hpp"

#include <tiny_obj_loader.h>

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

namespace voile::engine
{

namespace
{

Result<Polygons> parse(CheckedObj checked, const std::string& name)
{
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning;
    std::string error;
    std::istringstream text(std::move(checked.text));
    // Polygons stay whole: tinyobjloader cuts a concave quad along its shorter diagonal, even where that lies outside.
    const bool read =
        tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &text, nullptr, false, false);
    if (!read || shapes.size() != 1)
        return Error{name + ": cannot be parsed: " + gpu::printable(error)};

    Polygons polygons;
    const std::vector<float>& v = attributes.vertices;
    for (size_t i = 0; i + 2 < v.size(); i += 3)
        polygons.positions.emplace_back(v[i], v[i + 1], v[i + 2]);
    const std::vector<float>& vt = attributes.texcoords;
    for (size_t i = 0; i + 1 < vt.size(); i += 2)
        polygons.texture_coordinates.emplace_back(vt[i], vt[i + 1]);
    const std::vector<float>& vn = attributes.normals;
    for (size_t i = 0; i + 2 < vn.size(); i += 3)
        polygons.normals.emplace_back(vn[i], vn[i + 1], vn[i + 2]);
    for (const tinyobj::index_t& index : shapes.front().mesh.indices)
        polygons.corners.push_back({index.vertex_index, index.texcoord_index, index.normal_index});
    polygons.face_sizes = std::move(checked.face_sizes);
    return polygons;
}

template <typename Number>
void append_number(std::string& text, Number number)
{
    std::array<char, 32> digits{}; // shortest text that reads back as the same number
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text.append(" ").append(digits.data(), end);
}

} // namespace

Result<Mesh> load_obj(const std::filesystem::path& path, MeshReport* report, MeshVertices vertices)
{
    const std::string name = path_text(path);
    const Result<std::string> text = read_file(path);
    if (!text)
        return text.error();
    Result<CheckedObj> checked = check_obj(text.value(), name);
    if (!checked)
        return checked.error();
    Result<Polygons> polygons = parse(std::move(checked.value()), name);
    if (!polygons)
        return polygons.error();
    return build_mesh(std::move(polygons.value()), name, report, vertices);
}

Result<void> save_obj(const std::filesystem::path& path, const Mesh& mesh)
{
    std::string text;
    text.reserve(64 * (mesh.positions.size() + mesh.triangles.size()));
    for (size_t i = 0; i < mesh.positions.size(); ++i)
    {
        text += "v";
        for (int axis = 0; axis < 3; ++axis)
        {
            if (!std::isfinite(mesh.positions[i][axis]))
                return Error{path_text(path) + ": position " + std::to_string(i) + " is not finite"};
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
                return Error{path_text(path) + ": triangle " + std::to_string(i) + " refers to position " +
                             std::to_string(index) + " of " + std::to_string(mesh.positions.size())};
            append_number(text, index + 1);
        }
        text += "\n";
    }
    return write_file(path, text);
}

} // namespace voile::engine
