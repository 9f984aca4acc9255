// Reading PLY, and the selection of a mesh format.
#include "voile/engine/assets/ply.hpp"

#include "support/close_to.hpp"
#include "support/mesh_checks.hpp"
#include "support/test_folder.hpp"
#include "voile/engine/assets/load_mesh.hpp"
#include "voile/engine/assets/obj.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace
{

struct Loaded
{
    voile::engine::Mesh mesh;
    voile::engine::MeshReport report;
};

Loaded load(const std::string& bytes)
{
    const TestFolder folder;
    Loaded loaded;
    auto mesh = voile::engine::load_ply(folder.write("a.ply", bytes), &loaded.report);
    REQUIRE_MESSAGE(mesh, mesh.error().message);
    loaded.mesh = std::move(mesh.value());
    CHECK(loaded.mesh.normals.size() == loaded.mesh.positions.size());
    CHECK(loaded.mesh.texture_coordinates.size() == loaded.mesh.positions.size());
    return loaded;
}

// The error message for the bytes, with FILE as the file's name.
std::string message(const std::string& bytes)
{
    const TestFolder folder;
    const std::string path = folder.write("a.ply", bytes).string();
    const auto mesh = voile::engine::load_ply(path);
    if (mesh)
        return "accepted";
    const std::string& error = mesh.error().message;
    CHECK(error.find('\n') == std::string::npos);
    REQUIRE(error.starts_with(path));
    return "FILE" + error.substr(path.size());
}

const std::string k_vertex_properties = "property float x\nproperty float y\nproperty float z\n";
const std::string k_face_properties = "property list uchar int vertex_indices\n";

std::string header(const std::string& format, int vertices, int faces)
{
    return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices) + "\n" + k_vertex_properties +
           "element face " + std::to_string(faces) + "\n" + k_face_properties + "end_header\n"; // 9 lines
}

std::string ascii(int vertices, int faces, const std::string& body)
{
    return header("ascii", vertices, faces) + body;
}

const std::string k_triangle = "0 0 0\n0 0 1\n1 0 0\n"; // lines 10 to 12
const std::vector<glm::vec3> k_positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};

template <typename T>
std::string bytes_of(T value)
{
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename... Ts>
std::string join(Ts... values)
{
    return (bytes_of(values) + ...);
}

const std::string k_binary_triangle = join(0.f, 0.f, 0.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f);

std::string binary(const std::string& body, int vertices = 3, int faces = 1)
{
    return header("binary_little_endian", vertices, faces) + body;
}

} // namespace

TEST_CASE("an ASCII triangle")
{
    const Loaded loaded = load(ascii(3, 1, k_triangle + "3 0 1 2\n"));
    CHECK(loaded.mesh.positions == k_positions);
    CHECK(loaded.mesh.triangles == std::vector<glm::uvec3>{{0, 1, 2}});
    CHECK(loaded.mesh.normals == std::vector<glm::vec3>(3, {0, 1, 0}));
    CHECK(loaded.report.normals_computed);
}

TEST_CASE("a binary triangle")
{
    const Loaded loaded = load(binary(k_binary_triangle + join(uint8_t{3}, int32_t{0}, int32_t{1}, int32_t{2})));
    CHECK(loaded.mesh.positions == k_positions);
    CHECK(loaded.mesh.triangles == std::vector<glm::uvec3>{{0, 1, 2}});
    CHECK(loaded.mesh.normals == std::vector<glm::vec3>(3, {0, 1, 0}));
}

TEST_CASE("line ends, blank lines and comments are accepted")
{
    const std::string text = "ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\nelement vertex 3\n" +
                             k_vertex_properties + "element face 1\n" + k_face_properties +
                             "end_header\n0 0 0\n\n 0\t0 1\n1 0 0\n3 0 1 2";
    CHECK(load(text).mesh.positions == k_positions);
    std::string crlf;
    for (const char c : text)
        crlf += c == '\n' ? "\r\n" : std::string(1, c);
    CHECK(load(crlf).mesh.positions == k_positions);
}

TEST_CASE("other elements and properties are skipped, and the order of elements and coordinates is free")
{
    const std::string announced = " 1.0\nelement camera 2\nproperty list uchar short view\nproperty double zoom\n"
                                  "element nothing 3\n"
                                  "element face 1\nproperty uchar red\nproperty list ushort uchar vertex_index\n"
                                  "property list int float texcoord\n"
                                  "element vertex 3\nproperty double z\nproperty short x\nproperty float nx\n"
                                  "property list char double weights\nproperty float y\nend_header\n";
    const Loaded text = load("ply\nformat ascii" + announced +
                             "2 -7 8 0.5\n0 1e99\n"
                             "255 3 0 1 2 2 0.5 nan\n"
                             "0 0 9 1 0.5 0\n1 0 9 0 0\n0 1 9 2 1 1 0\n");
    CHECK(text.mesh.positions == k_positions);
    CHECK(text.mesh.triangles.size() == 1);
    const Loaded raw =
        load("ply\nformat binary_little_endian" + announced +
             join(uint8_t{2}, int16_t{-7}, int16_t{8}, 0.5, uint8_t{0}, 1e99) +
             join(uint8_t{255}, uint16_t{3}, uint8_t{0}, uint8_t{1}, uint8_t{2}, int32_t{2}, 0.5f, 0.25f) +
             join(0., int16_t{0}, 9.f, int8_t{1}, 0.5, 0.f) + join(1., int16_t{0}, 9.f, int8_t{0}, 0.f) +
             join(0., int16_t{1}, 9.f, int8_t{2}, 1., 1., 0.f));
    CHECK(raw.mesh.positions == k_positions);
    CHECK(raw.mesh.triangles.size() == 1);
}

TEST_CASE("a big-endian file is the same mesh as a little-endian one, in every type")
{
    const std::string announced = " 1.0\nelement vertex 3\nproperty double x\nproperty short y\nproperty float z\n"
                                  "property list ushort double weights\nproperty char a\nproperty uchar b\n"
                                  "property ushort c\nproperty int d\nproperty uint e\n"
                                  "element face 1\nproperty list int uint vertex_indices\nend_header\n";
    const auto reversed = [](auto value)
    {
        std::string bytes = bytes_of(value);
        std::reverse(bytes.begin(), bytes.end());
        return bytes;
    };
    std::string little;
    std::string big;
    const auto add = [&](auto value)
    {
        little += bytes_of(value);
        big += reversed(value);
    };
    const glm::dvec3 corners[] = {{0.1, -300, 1e-7}, {-1e3, 7, 2.5}, {3, 300, 1e2}};
    for (const glm::dvec3& p : corners)
    {
        add(p.x);
        add(static_cast<int16_t>(p.y));
        add(static_cast<float>(p.z));
        add(uint16_t{2});
        add(1e300);
        add(-0.25);
        add(int8_t{-7});
        add(uint8_t{200});
        add(uint16_t{60000});
        add(int32_t{-70000});
        add(uint32_t{4000000000});
    }
    add(int32_t{3});
    for (const uint32_t i : {2u, 0u, 1u})
        add(i);
    const Loaded here = load("ply\nformat binary_little_endian" + announced + little);
    const Loaded there = load("ply\ncomment a comment may come first\nformat binary_big_endian" + announced + big);
    CHECK(there.mesh.positions == here.mesh.positions);
    CHECK(there.mesh.positions[0] == glm::vec3(corners[0]));
    CHECK(there.mesh.triangles == here.mesh.triangles);
    CHECK(there.mesh.triangles == std::vector<glm::uvec3>{{2, 0, 1}});
    CHECK(message("ply\nformat binary_big_endian" + announced + big.substr(0, big.size() - 1)) ==
          "FILE: file ends before face 1 of 1 is complete");
    CHECK(message("ply\nformat binary_big_endian" + announced + little).starts_with("FILE: "));
}

TEST_CASE("a header of very many elements and properties is read quickly")
{
    const auto start = std::chrono::steady_clock::now();
    std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n" + k_vertex_properties;
    std::string body;
    for (int i = 0; i < 200000; ++i)
        text += "property list uchar int p" + std::to_string(i) + "\n";
    for (const std::string vertex : {"0 0 0", "0 0 1", "1 0 0"})
    {
        body += vertex;
        for (int i = 0; i < 200000; ++i)
            body += " 0";
        body += "\n";
    }
    text += "element face 1\n" + k_face_properties;
    for (int i = 0; i < 200000; ++i)
        text += "element e" + std::to_string(i) + " 0\n";
    CHECK(load(text + "end_header\n" + body + "3 0 1 2\n").mesh.positions == k_positions);
    CHECK(message(text + "element e7 0\n") == "FILE:400009: element 'e7' appears twice");
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    CHECK(elapsed.count() < 10);
}

TEST_CASE("every integer type works for counts and indices")
{
    for (const std::string count : {"char", "uchar", "short", "ushort", "int", "uint", "int8", "uint32"})
        for (const std::string index : {"int8", "uint8", "int16", "uint16", "int32", "uint32", "char", "uint"})
        {
            const auto size = [](const std::string& type)
            {
                return type.ends_with("8") || type.ends_with("char")             ? 1u
                       : type.find("16") != type.npos || type.ends_with("short") ? 2u
                                                                                 : 4u;
            };
            const auto number = [&](const std::string& type, uint32_t value)
            { return bytes_of(value).substr(0, size(type)); };
            const std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + k_vertex_properties +
                                     "element face 1\nproperty list " + count + " " + index +
                                     " vertex_index\nend_header\n" + k_binary_triangle + number(count, 3) +
                                     number(index, 0) + number(index, 1) + number(index, 2);
            CAPTURE(count);
            CAPTURE(index);
            CHECK(load(text).mesh.triangles == std::vector<glm::uvec3>{{0, 1, 2}});
        }
}

TEST_CASE("PLY faces are triangulated and cleaned like those of OBJ")
{
    const std::string vertices = "0 0 0\n1 0 3\n2 0 0\n1 0 1\n0.5 0 0\n"; // a dart, and a point on the x axis
    const Loaded loaded = load(ascii(5, 4, vertices + "4 0 1 2 3\n3 0 4 2\n3 0 1 3\n3 3 1 0\n"));
    CHECK(loaded.report.polygons_triangulated == 1);
    CHECK(loaded.report.degenerate_triangles == 1);
    CHECK(loaded.report.duplicate_triangles == 2);
    CHECK(loaded.mesh.triangles.size() == 2);
    CHECK(loaded.mesh.positions.size() == 4);
    CHECK(total_area(loaded.mesh) == tests::close_to(2., 1e-7));
}

TEST_CASE("an error in a PLY header names its line")
{
    CHECK(message("") == "FILE: file is empty");
    CHECK(message("solid\n") == "FILE:1: not a PLY file, the first line is not 'ply'");
    CHECK(message("ply\n") == "FILE: file ends before 'end_header'");
    CHECK(message("ply\nformat ascii 1.0\nelement vertex 3\nprop") ==
          "FILE:4: 'prop' is not a statement of a PLY header");
    CHECK(message("ply\nelement vertex 3\n") == "FILE:2: expected 'format FORMAT 1.0'");
    CHECK(message("ply\ncomment\n\nend_header\n") == "FILE:4: expected 'format FORMAT 1.0'");
    CHECK(message("ply\nformat binary_middle_endian 1.0\n") ==
          "FILE:2: format 'binary_middle_endian' is not ascii, binary_little_endian or binary_big_endian");
    CHECK(message("ply\nformat ascii 2.0\n") == "FILE:2: version '2.0' is not 1.0");
    const std::string start = "ply\nformat ascii 1.0\n";
    CHECK(message(start + "element vertex\n") == "FILE:3: expected 'element NAME COUNT'");
    for (const std::string count : {"-1", "x", "1.5", "2147483648", "99999999999999999999"})
        CHECK(message(start + "element vertex " + count + "\n") ==
              "FILE:3: count '" + count + "' is not a whole number from 0 to 2147483647");
    CHECK(message(start + "property float x\n") == "FILE:3: property before any element");
    CHECK(message(start + "element vertex 1\nproperty real x\n") == "FILE:4: type 'real' is not known");
    CHECK(message(start + "element vertex 1\nproperty float\n") ==
          "FILE:4: expected 'property TYPE NAME' or 'property list COUNT_TYPE TYPE NAME'");
    CHECK(message(start + "element vertex 1\nproperty float x\nproperty float x\n") ==
          "FILE:5: property 'x' appears twice");
    CHECK(message(start + "element vertex 1\nelement vertex 1\n") == "FILE:4: element 'vertex' appears twice");
    CHECK(message(start + "element face 1\n" + k_face_properties + "property list uchar int vertex_index\n") ==
          "FILE:5: property 'vertex_index' appears twice");
    CHECK(message(start + "element face 1\nproperty list float int a\n") ==
          "FILE:4: list 'a' is counted or indexed by float, needs an integer type");
    CHECK(message(start + "element face 1\nproperty list uchar double vertex_index\n") ==
          "FILE:4: list 'vertex_index' is counted or indexed by double, needs an integer type");
}

TEST_CASE("a PLY file without a mesh is refused")
{
    const std::string start = "ply\nformat ascii 1.0\n";
    CHECK(message(start + "end_header\n") == "FILE: no vertices");
    CHECK(message(ascii(0, 0, "")) == "FILE: no vertices");
    CHECK(message(ascii(3, 0, k_triangle)) == "FILE: no faces");
    CHECK(message(start + "element vertex 3\nproperty float x\nproperty float z\nend_header\n") ==
          "FILE: vertices have no property 'y'");
    CHECK(message(start + "element vertex 3\n" + k_vertex_properties +
                  "element face 1\nproperty int vertex_index\nend_header\n") ==
          "FILE: faces have no list 'vertex_indices' or 'vertex_index'");
    CHECK(message(ascii(3, 2, k_triangle + "3 0 0 1\n3 1 1 1\n")) == "FILE: no triangles left, all 2 are degenerate");
}

TEST_CASE("an error in an ASCII body names its line")
{
    CHECK(message(ascii(3, 1, "0 0 0\n0 0\n")) == "FILE:11: vertex has too few values");
    CHECK(message(ascii(3, 1, "0 0 0\n0 0 1 7\n")) == "FILE:11: vertex has too many values, '7' is left over");
    CHECK(message(ascii(3, 1, "0 0 0\n\n0 0 x\n")) == "FILE:12: 'x' is not a number");
    for (const std::string number : {"nan", "-inf", "1e999", "1e39"})
        CHECK(message(ascii(3, 1, "0 0 " + number + "\n")) == "FILE:10: coordinate is not finite");
    CHECK(message(ascii(3, 1, k_triangle + "3 0 1 3\n")) == "FILE:13: face refers to vertex 3, indices go from 0 to 2");
    CHECK(message(ascii(3, 1, k_triangle + "3 0 1 -1\n")) ==
          "FILE:13: face refers to vertex -1, indices go from 0 to 2");
    CHECK(message(ascii(3, 1, k_triangle + "3 0 1 1.5\n")) == "FILE:13: '1.5' is not a whole number of 32 bits");
    CHECK(message(ascii(3, 1, k_triangle + "3 0 1 1e30\n")) == "FILE:13: '1e30' is not a whole number of 32 bits");
    CHECK(message(ascii(3, 1, k_triangle + "3 0 1 nan\n")) == "FILE:13: 'nan' is not a whole number of 32 bits");
    CHECK(message(ascii(3, 1, k_triangle + "2 0 1\n")) == "FILE:13: face has 2 corners, needs 3");
    CHECK(message(ascii(3, 1, k_triangle + "-3 0 1 2\n")) == "FILE:13: list has -3 values");
    CHECK(message(ascii(3, 1, k_triangle + "3 0 1\n")) == "FILE:13: face has too few values");
    CHECK(message(ascii(3, 1, k_triangle + "4294967295 0 1 2\n")) == "FILE:13: face has too few values");
    CHECK(message(ascii(3, 1, k_triangle + "3 0 1 2\n3 0 1 2\n")) == "FILE:14: data follows the last face");
    CHECK(message(ascii(3, 1, k_triangle + "3 0 1 2\n\n \nmore\n")) == "FILE:16: data follows the last face");
}

TEST_CASE("a truncated ASCII body is refused")
{
    CHECK(message(ascii(3, 1, "0 0 0\n0 0 1\n")) == "FILE:11: file ends before vertex 3 of 3 is complete");
    CHECK(message(ascii(3, 1, "0 0 0\n0 0")) == "FILE:11: vertex has too few values");
    CHECK(message(ascii(3, 2, k_triangle + "3 0 1 2\n")) == "FILE:13: file ends before face 2 of 2 is complete");
    CHECK(message(ascii(2147483647, 1, k_triangle)) == "FILE:12: file ends before vertex 4 of 2147483647 is complete");
}

TEST_CASE("an error in a binary body names the vertex or face")
{
    const auto face = [](int32_t last) { return join(uint8_t{3}, int32_t{0}, int32_t{1}, last); };
    CHECK(message(binary(k_binary_triangle + face(3))) ==
          "FILE: face 1 of 1: face refers to vertex 3, indices go from 0 to 2");
    CHECK(message(binary(k_binary_triangle + face(-1))) ==
          "FILE: face 1 of 1: face refers to vertex -1, indices go from 0 to 2");
    CHECK(message(binary(k_binary_triangle + join(uint8_t{2}, int32_t{0}, int32_t{1}))) ==
          "FILE: face 1 of 1: face has 2 corners, needs 3");
    CHECK(message(binary(join(0.f, 0.f, 0.f, 0.f, std::numeric_limits<float>::quiet_NaN(), 0.f))) ==
          "FILE: vertex 2 of 3: coordinate is not finite");
    CHECK(message(binary(join(std::numeric_limits<float>::infinity(), 0.f, 0.f))) ==
          "FILE: vertex 1 of 3: coordinate is not finite");
    CHECK(message(binary(k_binary_triangle + face(2) + "x")) == "FILE: data follows the last face");
    CHECK(message(binary(k_binary_triangle + face(2) + "\n")) == "accepted");
}

TEST_CASE("a binary body truncated anywhere is refused")
{
    const std::string body = k_binary_triangle + join(uint8_t{3}, int32_t{0}, int32_t{1}, int32_t{2});
    for (size_t length = 0; length < body.size(); ++length)
    {
        CAPTURE(length);
        const std::string entry =
            length < 36 ? "vertex " + std::to_string(length / 12 + 1) + " of 3" : std::string("face 1 of 1");
        REQUIRE(message(binary(body.substr(0, length))) == "FILE: file ends before " + entry + " is complete");
    }
}

TEST_CASE("an unreadable PLY file is named with the system's reason")
{
    const TestFolder folder;
    const std::string missing = (folder / "gone.ply").string();
    CHECK(voile::engine::load_ply(missing).error().message == missing + ": cannot read: No such file or directory");
    std::filesystem::create_directory(folder / "folder.ply");
    const std::string directory = (folder / "folder.ply").string();
    CHECK(voile::engine::load_ply(directory).error().message == directory + ": cannot read: Is a directory");
}

TEST_CASE("the extension selects the format of a mesh")
{
    const TestFolder folder;
    const std::string obj = "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3 1\n";
    const std::string ply = ascii(3, 2, k_triangle + "3 0 1 2\n3 0 1 2\n");
    for (const std::string name : {"a.obj", "A.OBJ", "b.c.Obj"})
    {
        voile::engine::MeshReport report;
        CHECK(voile::engine::load_mesh(folder.write(name, obj), &report).has_value());
        CHECK(report.polygons_triangulated == 1);
    }
    for (const std::string name : {"a.ply", "A.PLY"})
    {
        voile::engine::MeshReport report;
        CHECK(voile::engine::load_mesh(folder.write(name, ply), &report).has_value());
        CHECK(report.duplicate_triangles == 1);
    }
    for (const std::string name : {"a.stl", "obj", "a.obj.gz", ".ply"})
    {
        const std::string path = folder.write(name, obj).string();
        CHECK(voile::engine::load_mesh(path).error().message ==
              path + ": not a mesh format that can be read, the name does not end in .obj or .ply");
    }
}
