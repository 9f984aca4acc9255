// Reading OBJ.
#include "voile/engine/assets/obj.hpp"

#include "support/close_to.hpp"
#include "support/mesh_checks.hpp"
#include "support/test_folder.hpp"
#include "voile/engine/assets/file.hpp"
#include "voile/engine/assets/shapes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

namespace
{

const std::string k_triangle = "v 0 0 0\nv 0 0 1\nv 1 0 0\n";

struct Loaded
{
    voile::engine::Mesh mesh;
    voile::engine::MeshReport report;
};

Loaded load(const std::string& text)
{
    const TestFolder folder;
    Loaded loaded;
    auto mesh = voile::engine::load_obj(folder.write("a.obj", text), &loaded.report);
    REQUIRE_MESSAGE(mesh, mesh.error().message);
    loaded.mesh = std::move(mesh.value());
    CHECK(loaded.mesh.normals.size() == loaded.mesh.positions.size());
    CHECK(loaded.mesh.texture_coordinates.size() == loaded.mesh.positions.size());
    return loaded;
}

// The error message for the text, with FILE as the file's name.
std::string message(const std::string& text)
{
    const TestFolder folder;
    const std::string path = folder.write("a.obj", text).string();
    const auto mesh = voile::engine::load_obj(path);
    if (mesh)
        return "accepted";
    const std::string& error = mesh.error().message;
    CHECK(error.find('\n') == std::string::npos);
    REQUIRE(error.starts_with(path));
    return "FILE" + error.substr(path.size());
}

} // namespace

TEST_CASE("a triangle")
{
    const Loaded loaded = load(k_triangle + "f 1 2 3\n");
    CHECK(loaded.mesh.positions == std::vector<glm::vec3>{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}});
    CHECK(loaded.mesh.triangles == std::vector<glm::uvec3>{{0, 1, 2}});
    CHECK(loaded.mesh.normals == std::vector<glm::vec3>(3, {0, 1, 0}));
    CHECK(loaded.mesh.texture_coordinates == std::vector<glm::vec2>(3, {0, 0}));
    CHECK(loaded.report.normals_computed);
    CHECK(loaded.report.polygons_triangulated == 0);
    CHECK(loaded.report.degenerate_triangles == 0);
    CHECK(loaded.report.duplicate_triangles == 0);
}

TEST_CASE("polygons are triangulated, concave ones within their outline")
{
    const Loaded loaded = load("v 0 0 0\nv 1 0 3\nv 2 0 0\nv 1 0 1\n"            // a dart
                               "v 5 0 0\nv 5 0 1\nv 6 0 1\nv 6 0 0\n"            // a square
                               "v 8 0 0\nv 8 0 2\nv 9 0 3\nv 10 0 2\nv 10 0 0\n" // a house
                               "f 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12 13\n");
    CHECK(loaded.mesh.triangles.size() == 7);
    CHECK(loaded.report.polygons_triangulated == 3);
    CHECK(total_area(loaded.mesh) == tests::close_to(2. + 1. + 5., 1e-7)); // more if triangulated outside the outline
    CHECK(loaded.mesh.normals == std::vector<glm::vec3>(13, {0, 1, 0}));
}

TEST_CASE("a polygon may have more corners than fit in a byte")
{
    constexpr int k_corners = 300;
    std::string text;
    std::string face = "f";
    for (int i = 0; i < k_corners; ++i)
    {
        const double angle = -2. * 3.14159265358979 * i / k_corners;
        text += "v " + std::to_string(std::cos(angle)) + " 0 " + std::to_string(std::sin(angle)) + "\n";
        face += ' ' + std::to_string(i + 1);
    }
    const Loaded loaded = load(text + face + "\n");
    CHECK(loaded.mesh.triangles.size() == k_corners - 2);
    CHECK(total_area(loaded.mesh) == tests::close_to(3.14159, 3e-4));
}

TEST_CASE("negative indices count back from their line")
{
    const Loaded loaded = load(k_triangle + "f -3 -2 -1\nv 5 0 0\nv 5 0 1\nv 6 0 0\nf -3 -2 -1\n");
    CHECK(loaded.mesh.triangles == std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}});
    CHECK(loaded.mesh.positions[4] == glm::vec3(5, 0, 1));
}

TEST_CASE("a face may refer to later vertices")
{
    CHECK(load("f 1 2 3\n" + k_triangle).mesh.triangles.size() == 1);
}

TEST_CASE("texture coordinates and normals are read in all forms of a corner")
{
    const std::string lists = k_triangle + "vt 0.5 0.25\nvt 1 0\nvn 0 2 0\nvn 1 0 0\n";
    const Loaded both = load(lists + "f 1/1/1 2/2/1 3/1/1\n");
    CHECK_FALSE(both.report.normals_computed);
    CHECK(both.mesh.texture_coordinates == std::vector<glm::vec2>{{0.5, 0.25}, {1, 0}, {0.5, 0.25}});
    CHECK(both.mesh.normals == std::vector<glm::vec3>(3, {0, 1, 0})); // normalized

    const Loaded texture = load(lists + "f 1/1 2/2 3/-1\n");
    CHECK(texture.report.normals_computed);
    CHECK(texture.mesh.texture_coordinates == std::vector<glm::vec2>{{0.5, 0.25}, {1, 0}, {1, 0}});

    const Loaded normal = load(lists + "f 1//2 2//2 3//-1\n");
    CHECK_FALSE(normal.report.normals_computed);
    CHECK(normal.mesh.normals == std::vector<glm::vec3>(3, {1, 0, 0}));
    CHECK(normal.mesh.texture_coordinates == std::vector<glm::vec2>(3, {0, 0}));

    // One corner without a normal, or with one of zero length: all are computed.
    CHECK(load(lists + "f 1//2 2//2 3\n").mesh.normals == std::vector<glm::vec3>(3, {0, 1, 0}));
    CHECK(load(lists + "vn 0 0 0\nf 1//2 2//2 3//3\n").mesh.normals == std::vector<glm::vec3>(3, {0, 1, 0}));
}

TEST_CASE("a normal may be so long that its square overflows a float")
{
    const Loaded loaded = load(k_triangle + "vn 0 1e30 0\nf 1//1 2//1 3//1\n");
    CHECK(loaded.mesh.normals == std::vector<glm::vec3>(3, {0, 1, 0}));
}

TEST_CASE("a position with two texture coordinates becomes two vertices")
{
    const Loaded loaded = load(k_triangle + "v 1 0 1\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 3/2 2/2 4/2\n");
    CHECK(loaded.mesh.positions.size() == 6);
    CHECK(loaded.mesh.triangles.size() == 2);
}

TEST_CASE("positions that no triangle uses are left out")
{
    const Loaded loaded = load("v 9 9 9\n" + k_triangle + "f 2 3 4\n");
    CHECK(loaded.mesh.positions == std::vector<glm::vec3>{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}});
}

TEST_CASE(
    "vertices by position are the file's own in its order, whatever texture coordinates and normals the corners have")
{
    const TestFolder folder;
    // Two triangles that share an edge but no texture coordinate and no normal, and an unused vertex.
    const std::string path =
        folder.write("a.obj", "v 0 0 0\nv 9 9 9\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n"
                              "vn 0 1 0\nvn 0 0 1\nf 4/1/1 3/2/1 1/3/1\nf 1/1/2 5/2/2 4/3/2\n");
    CHECK(voile::engine::load_obj(path).value().positions.size() == 6); // both corners of the edge twice
    const auto mesh = voile::engine::load_obj(path, nullptr, voile::engine::MeshVertices::positions);
    REQUIRE(mesh);
    REQUIRE(mesh.value().positions.size() == 5);
    CHECK(mesh.value().positions[1] == glm::vec3(9));
    CHECK(mesh.value().positions[4] == glm::vec3(0, 0, 1));
    CHECK(mesh.value().triangles[0] == glm::uvec3(3, 2, 0));
    CHECK(mesh.value().triangles[1] == glm::uvec3(0, 4, 3));
    CHECK(mesh.value().texture_coordinates[3] == glm::vec2(0, 0));
    // The file's texture coordinates with their seam; none if a corner has none.
    CHECK(mesh.value().texture_map.coordinates == std::vector<glm::vec2>{{0, 0}, {1, 0}, {1, 1}});
    CHECK(mesh.value().texture_map.triangles == std::vector<glm::uvec3>{{0, 1, 2}, {0, 1, 2}});
    const std::string part = folder.write("b.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nvt 0 0\nf 1/1 3 2/1\n");
    const auto partly = voile::engine::load_obj(part, nullptr, voile::engine::MeshVertices::positions);
    REQUIRE(partly);
    CHECK(partly.value().texture_map.triangles.empty());
    CHECK(std::abs(mesh.value().normals[0].y) == 1);
}

TEST_CASE("line ends, blanks, comments, continued lines, weights, colors and a byte order mark are accepted")
{
    const voile::engine::Mesh plain = load(k_triangle + "f 1 2 3\n").mesh;
    for (const std::string& text : {
             std::string("v 0 0 0\r\nv 0 0 1\r\nv 1 0 0\r\nf 1 2 3\r\n"),
             std::string("v 0 0 0\rv 0 0 1\rv 1 0 0\rf 1 2 3\r"),
             "\xEF\xBB\xBF" + k_triangle + "f 1 2 3", // and no line feed at the end
             std::string("# C:\\models\\\n\n  v\t0 0   0 # first\nv 0 0 1 #\nv +1 -0 .0e1\n\nf 1 2 3 # all\n"),
             std::string("v 0 \\\n0 0\nv 0 0 1\nv 1 0 0\nf 1 \\\r\n2 \\\n3\n"),
             std::string("v 0 0 0 1\nv 0 0 1 0.5 0.5 0.5\nv 1 0 0 1 0 0 0\nf 1 2 3\n"),
         })
    {
        CAPTURE(text);
        const Loaded loaded = load(text);
        CHECK(loaded.mesh.positions == plain.positions);
        CHECK(loaded.mesh.triangles == plain.triangles);
    }
}

TEST_CASE("objects and groups become one mesh, and other statements are ignored")
{
    const Loaded loaded = load("mtllib gone.mtl\no one\n" + k_triangle +
                               "g a b\nusemtl red\ns 1\nf 1 2 3\no two\ng\ns off\nv 1 0 1\nl 1 2\np 1\nf 3 2 4\n");
    CHECK(loaded.mesh.triangles == std::vector<glm::uvec3>{{0, 1, 2}, {2, 1, 3}});
}

TEST_CASE("degenerate and duplicate triangles are dropped and counted")
{
    const Loaded loaded = load(k_triangle + "v 0.5 0 0\nv 0 0 0\n"
                                            "f 1 2 3\n"
                                            "f 1 4 3\n" // collinear
                                            "f 1 1 2\n" // a repeated corner
                                            "f 1 5 2\n" // two corners at one position
                                            "f 2 3 1\n" // the first again
                                            "f 3 2 1\n" // the first, flipped
                                            "f 5 2 3\n" // the first with a repeated position
    );
    CHECK(loaded.mesh.triangles.size() == 1);
    CHECK(loaded.report.degenerate_triangles == 3);
    CHECK(loaded.report.duplicate_triangles == 3);
}

TEST_CASE("a thin triangle is kept unless its height is within rounding")
{
    CHECK(load("v 0 0 0\nv 1 0 0\nv 0.5 0.00001 0\nf 1 2 3\n").mesh.triangles.size() == 1);
    CHECK(message("v 0 0 0\nv 1 0 0\nv 0.5 0.0000001 0\nf 1 2 3\n") == "FILE: no triangles left, all 1 are degenerate");
    CHECK(load("v 0 0 0\nv 1e-30 0 0\nv 0 1e-30 0\nf 1 2 3\n").mesh.triangles.size() == 1); // small is not thin
}

TEST_CASE("computed normals do not depend on the triangulation of a flat face")
{
    // A cube's corner: three faces, one of them cut in two at the corner.
    const Loaded loaded =
        load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 0\nv 1 0 1\nv 0 1 1\n"
             "f 1 2 5\nf 1 5 3\nf 1 4 2\nf 4 6 2\nf 1 3 4\nf 3 7 4\n"); // xy has two triangles at 1, the others one
    const glm::vec3 normal = loaded.mesh.normals[0];
    CHECK(std::abs(normal.x) == tests::close_to(1. / std::sqrt(3.), 8e-8));
    CHECK(std::abs(normal.y) == tests::close_to(std::abs(normal.x), 8e-8));
    CHECK(std::abs(normal.z) == tests::close_to(std::abs(normal.x), 8e-8));
}

TEST_CASE("computed normals of a sphere are close to radial")
{
    // save_obj writes no normals. The seam's vertices see one side only, the poles' a single triangle.
    const TestFolder folder;
    const uint32_t rings = 48;
    REQUIRE(voile::engine::save_obj(folder / "a.obj", voile::engine::make_sphere({0, 0, 0}, 1.f, rings)));
    voile::engine::MeshReport report;
    const auto sphere = voile::engine::load_obj(folder / "a.obj", &report);
    REQUIRE(sphere);
    CHECK(report.normals_computed);
    CHECK(report.degenerate_triangles == 0);
    // A triangle's normal deviates by half its size at most, which is pi / 48 across.
    for (size_t i = 0; i < sphere.value().positions.size(); ++i)
    {
        const glm::vec3 p = sphere.value().positions[i];
        const bool at_seam = p.x > 0 && std::abs(p.z) < 1e-3f;
        const bool at_pole = std::abs(p.y) > 0.9999f;
        REQUIRE(glm::dot(sphere.value().normals[i], p) > (at_seam || at_pole ? 0.998f : 0.99999f));
    }
}

TEST_CASE("an error names the file, the line and the reason")
{
    CHECK(message(k_triangle + "v 1 2\nf 1 2 3\n") == "FILE:4: vertex has 2 coordinates, needs 3");
    CHECK(message("v\n") == "FILE:1: vertex has 0 coordinates, needs 3");
    CHECK(message("v 1 2 3 4 5\n") == "FILE:1: vertex has 5 numbers, needs 3, 4 with a weight or 6 with a color");
    CHECK(message("v 1 2 3 4 5 6 7 8\n") == "FILE:1: vertex has 8 coordinates, needs 3");
    CHECK(message("v 1 2 x\n") == "FILE:1: 'x' is not a number");
    CHECK(message("v 1 2 3,5\n") == "FILE:1: '3,5' is not a number");
    CHECK(message("v 1 2 +-3\n") == "FILE:1: '+-3' is not a number");
    CHECK(message("v 1 2 0x3\n") == "FILE:1: '0x3' is not a number");
    CHECK(message("v 1 2 1e\n") == "FILE:1: '1e' is not a number");
    CHECK(message("\n\nv 1 2 nan\n") == "FILE:3: coordinate is not finite");
    CHECK(message("v 1 -inf 2\n") == "FILE:1: coordinate is not finite");
    CHECK(message("v 1 1e999 2\n") == "FILE:1: coordinate is not finite");
    CHECK(message("v 1 1e39 2\n") == "FILE:1: coordinate is not finite"); // overflows a float
    CHECK(message(k_triangle + "vt 0 0\nvt 1e30 0\nf 1/1 2/2 3/1\n") ==
          "FILE:5: texture coordinate is '1e30', must be within 1e6");
    CHECK(message(k_triangle + "vt -1000001\nf 1/1 2/1 3/1\n") ==
          "FILE:4: texture coordinate is '-1000001', must be within 1e6");
    CHECK(message("vt\n") == "FILE:1: texture coordinate has 0 coordinates, needs 1 to 3");
    CHECK(message("vt 0 0 0 0\n") == "FILE:1: texture coordinate has 4 coordinates, needs 1 to 3");
    CHECK(message("vn 1 0\n") == "FILE:1: normal has 2 coordinates, needs 3");
    CHECK(message("v 1 \\\n2 \\\n3\nv 1 a\n") == "FILE:4: vertex has 2 coordinates, needs 3");
    CHECK(message(k_triangle + "f 1 2\n") == "FILE:4: face has 2 corners, needs 3");
    CHECK(message(k_triangle + "f 1 2 4\n") == "FILE:4: face refers to position 4 of 3");
    CHECK(message(k_triangle + "f 0 1 2\n") == "FILE:4: face refers to position 0, indices start at 1");
    CHECK(message(k_triangle + "f 1 2 -4\n") == "FILE:4: face refers to position -4 after only 3");
    CHECK(message(k_triangle + "f 1/1 2/1 3/1\n") == "FILE:4: face refers to texture coordinate 1 of 0");
    CHECK(message(k_triangle + "f 1//1 2//1 3//1\n") == "FILE:4: face refers to normal 1 of 0");
    const std::string form = "' is not position[/texture coordinate][/normal]";
    for (const char* corner : {"a", "1/", "1//", "1/2/3/4", "1.5", "/1", "99999999999999999999", "1 2 3/x"})
    {
        CAPTURE(corner);
        CHECK(message(k_triangle + "vt 0 0\nvt 0 0\nvn 0 1 0\nvn 0 1 0\nvn 0 1 0\nf " + corner + " 2 3\n")
                  .ends_with(form));
    }
    CHECK(message("v " + std::string(100, 'x') + " 0 0\n") ==
          "FILE:1: '" + std::string(40, 'x') + "...' is not a number");
    CHECK(message("v \x01 0 0\n") == "FILE:1: '?' is not a number");
}

TEST_CASE("the error names the first faulty line")
{
    CHECK(message("v 0 0 x\nv 0 y 0\n") == "FILE:1: 'x' is not a number");
}

TEST_CASE("a number too small for a double is zero")
{
    CHECK(load("v 1e-999 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n").mesh.positions[0] == glm::vec3(0));
}

TEST_CASE("a file without a mesh is refused")
{
    CHECK(message("") == "FILE: file is empty");
    CHECK(message(" \r\n\t\n") == "FILE: file is empty");
    CHECK(message("# nothing\n") == "FILE: no vertices");
    CHECK(message(k_triangle) == "FILE: no faces");
    CHECK(message(k_triangle + "f 1 1 2\nf 2 2 2\n") == "FILE: no triangles left, all 2 are degenerate");
    CHECK(message(std::string("v 0\0 0 0\n", 9)) == "FILE: not a text file, byte 3 is zero");
}

TEST_CASE("a file truncated in the middle of a line is refused")
{
    CHECK(message("v 0 0 0\nv 0 0 1\nv 1 0") == "FILE:3: vertex has 2 coordinates, needs 3");
    CHECK(message(k_triangle + "f 1 2") == "FILE:4: face has 2 corners, needs 3");
    CHECK(message(k_triangle + "f 1 2 3\nv 1 0 -") == "FILE:5: '-' is not a number");
}

TEST_CASE("an unreadable file is named with the system's reason")
{
    const TestFolder folder;
    const std::string missing = (folder / "gone.obj").string();
    CHECK(voile::engine::load_obj(missing).error().message == missing + ": cannot read: No such file or directory");
    std::filesystem::create_directory(folder / "folder.obj");
    const std::string directory = (folder / "folder.obj").string();
    CHECK(voile::engine::load_obj(directory).error().message == directory + ": cannot read: Is a directory");
}

// VOILE_TEST_MESHES names a folder of OBJ files from other sources. Without it there is nothing to test.
TEST_CASE("meshes of other sources load")
{
    const char* meshes = std::getenv("VOILE_TEST_MESHES");
    if (meshes == nullptr)
        return;
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(meshes))
    {
        if (entry.path().extension() != ".obj")
            continue;
        ++count;
        CAPTURE(entry.path().string());
        voile::engine::MeshReport report;
        const auto mesh = voile::engine::load_obj(entry.path(), &report);
        REQUIRE_MESSAGE(mesh, mesh.error().message);
        MESSAGE(entry.path().filename().string(), ": ", mesh.value().positions.size(), " vertices, ",
                mesh.value().triangles.size(), " triangles, ", report.polygons_triangulated, " polygons, ",
                report.degenerate_triangles, " degenerate, ", report.duplicate_triangles, " duplicate");
        CHECK(mesh.value().triangles.size() > 100);
        for (const glm::vec3& normal : mesh.value().normals)
            REQUIRE(glm::length(normal) == tests::close_to(1.f, 1e-5));
        for (const glm::uvec3& t : mesh.value().triangles)
            REQUIRE(std::max({t.x, t.y, t.z}) < mesh.value().positions.size());
    }
    CHECK(count > 0);
}
