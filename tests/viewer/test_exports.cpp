// Exported surfaces: every byte of a small one, and that a reader gets back the same bits.
#include "samples/viewer/exports.hpp"
#include "samples/viewer/point_cache.hpp"
#include "support/test_folder.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace
{

namespace fs = std::filesystem;

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_infinity = std::numeric_limits<float>::infinity();

viewer::Surface triangle(const std::string& name)
{
    return {name, {{0, 0, 0}, {1, 0, 0}, {0, 0.5f, -1}}, {}, {}, {3, {0, 1, 2}, {}}};
}

// Values whose decimal text is long, tiny, huge or signed.
viewer::Surface awkward()
{
    viewer::Surface surface;
    surface.name = "awkward";
    surface.positions = {{0.1f, 1.f / 3.f, -0.f},
                         {1e-45f, 3.4028235e38f, 1.17549435e-38f},
                         {16777217.f, -123456.789f, 2.7182817f},
                         {1e10f, -1e-10f, 100000.f}};
    surface.normals = {{0, 1, 0}, {0, 0, -1}, {0.57735026f, 0.57735026f, 0.57735026f}, {1, 0, 0}};
    surface.faces.indices = {0, 1, 2, 3, 2, 1};
    return surface;
}

bool same_bits(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec3)) == 0;
}

viewer::Surface read_obj(const std::string& text)
{
    viewer::Surface surface;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
    {
        std::istringstream words(line);
        std::string keyword;
        std::string a, b, c;
        words >> keyword >> a >> b >> c;
        const auto index = [](const std::string& s) { return static_cast<uint32_t>(std::stoul(s)) - 1; };
        if (keyword == "v" || keyword == "vn")
        {
            auto& list = keyword == "v" ? surface.positions : surface.normals;
            list.emplace_back(std::strtof(a.c_str(), nullptr), std::strtof(b.c_str(), nullptr),
                              std::strtof(c.c_str(), nullptr));
        }
        if (keyword == "f")
            surface.faces.indices.insert(surface.faces.indices.end(), {index(a), index(b), index(c)});
    }
    return surface;
}

template <typename T>
T take(std::string& bytes)
{
    REQUIRE(bytes.size() >= sizeof(T));
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    bytes.erase(0, sizeof(T));
    return value;
}

viewer::Surface read_ply(std::string bytes)
{
    viewer::Surface surface;
    size_t vertices = 0;
    size_t faces = 0;
    bool normals = false;
    for (std::string line; line != "end_header";)
    {
        const size_t end = bytes.find('\n');
        REQUIRE(end != std::string::npos);
        line = bytes.substr(0, end);
        bytes.erase(0, end + 1);
        if (line.starts_with("element vertex "))
            vertices = std::stoul(line.substr(15));
        if (line.starts_with("element face "))
            faces = std::stoul(line.substr(13));
        normals = normals || line == "property float nx";
    }
    for (size_t i = 0; i < vertices; ++i)
    {
        surface.positions.push_back(take<glm::vec3>(bytes));
        if (normals)
            surface.normals.push_back(take<glm::vec3>(bytes));
    }
    for (size_t i = 0; i < faces; ++i)
    {
        REQUIRE(take<uint8_t>(bytes) == 3);
        for (int corner = 0; corner < 3; ++corner)
            surface.faces.indices.push_back(take<uint32_t>(bytes));
    }
    CHECK(bytes.empty());
    return surface;
}

template <typename T>
std::string error_of(const T& result)
{
    return result ? "accepted" : result.error().message;
}

} // namespace

TEST_CASE("an OBJ, byte for byte")
{
    const TestFolder folder;
    viewer::Surface surface = triangle("sheet");
    REQUIRE(viewer::save_surface_obj(folder / "a.obj", surface));
    CHECK(folder.read("a.obj") == "# meters, y up\no sheet\nv 0 0 0\nv 1 0 0\nv 0 0.5 -1\nf 1 2 3\n");
    surface.normals.assign(3, {0, 0, 1});
    REQUIRE(viewer::save_surface_obj(folder / "a.obj", surface));
    CHECK(folder.read("a.obj") == "# meters, y up\no sheet\nv 0 0 0\nv 1 0 0\nv 0 0.5 -1\n"
                                  "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf 1//1 2//2 3//3\n");
    CHECK(folder.entries() == 1);
}

TEST_CASE("a PLY, byte for byte")
{
    const TestFolder folder;
    REQUIRE(viewer::save_surface_ply(folder / "a.ply", triangle("sheet")));
    std::string expected = "ply\nformat binary_little_endian 1.0\ncomment meters, y up\nelement vertex 3\n"
                           "property float x\nproperty float y\nproperty float z\nelement face 1\n"
                           "property list uchar int vertex_indices\nend_header\n";
    expected += std::string("\0\0\0\0\0\0\0\0\0\0\0\0", 12) + std::string("\0\0\x80\x3f\0\0\0\0\0\0\0\0", 12) +
                std::string("\0\0\0\0\0\0\0\x3f\0\0\x80\xbf", 12) + std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
    CHECK(folder.read("a.ply") == expected);
}

TEST_CASE("a grid is written as quads that keep the winding, with texture coordinates and normals")
{
    const TestFolder folder;
    viewer::Surface grid{"g", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}}, {}, {}, {}};
    grid.faces = viewer::grid_faces(3, 2);
    grid.texture_coordinates = viewer::grid_texture_coordinates(3, 2);
    grid.normals = viewer::surface_normals(grid.positions, grid.faces);
    REQUIRE(viewer::save_surface_obj(folder / "a.obj", grid));
    CHECK(folder.read("a.obj").ends_with("vt 0 1\nvt 0.5 1\nvt 1 1\nvt 0 0\nvt 0.5 0\nvt 1 0\n"
                                         "vn 0 1 0\nvn 0 1 0\nvn 0 1 0\nvn 0 1 0\nvn 0 1 0\nvn 0 1 0\n"
                                         "f 1/1/1 4/4/4 5/5/5 2/2/2\nf 2/2/2 5/5/5 6/6/6 3/3/3\n"));
    REQUIRE(viewer::save_surface_ply(folder / "a.ply", grid));
    std::string ply = folder.read("a.ply");
    CHECK(ply.find("property float nz\nproperty float s\nproperty float t\nelement face 2\n") != std::string::npos);
    ply.erase(0, ply.find("end_header\n") + 11);
    for (size_t i = 0; i < 6; ++i)
    {
        CHECK(take<glm::vec3>(ply) == grid.positions[i]);
        CHECK(take<glm::vec3>(ply) == glm::vec3(0, 1, 0));
        CHECK(take<glm::vec2>(ply) == grid.texture_coordinates[i]);
    }
    for (const uint32_t index : {0u, 3u, 4u, 1u, 1u, 4u, 5u, 2u})
    {
        if (index == 0 || ply.size() == 17)
            REQUIRE(take<uint8_t>(ply) == 4);
        CHECK(take<uint32_t>(ply) == index);
    }
    CHECK(ply.empty());
}

TEST_CASE("texture coordinates keep their seams")
{
    const TestFolder folder;
    viewer::Surface surface = triangle("t");
    surface.texture_coordinates = {{0, 0}, {0.25f, 1}, {1, 0.5f}, {9, 9}};
    surface.faces.texture_indices = {2, 0, 1};
    REQUIRE(viewer::save_surface_obj(folder / "a.obj", surface));
    CHECK(folder.read("a.obj").ends_with("vt 0 0\nvt 0.25 1\nvt 1 0.5\nvt 9 9\nf 1/3 2/1 3/2\n"));
    REQUIRE(viewer::save_surface_ply(folder / "a.ply", surface));
    std::string ply = folder.read("a.ply");
    CHECK(ply.find("property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n") !=
          std::string::npos);
    ply.erase(0, ply.size() - 25);
    CHECK(take<uint8_t>(ply) == 6);
    CHECK(take<glm::vec2>(ply) == glm::vec2(1, 0.5f));
    CHECK(take<glm::vec2>(ply) == glm::vec2(0, 0));
    CHECK(take<glm::vec2>(ply) == glm::vec2(0.25f, 1));
}

TEST_CASE("OBJ and PLY preserve all bits and the order")
{
    const TestFolder folder;
    const viewer::Surface surface = awkward();
    REQUIRE(viewer::save_surface_obj(folder / "a.obj", surface));
    REQUIRE(viewer::save_surface_ply(folder / "a.ply", surface));
    for (const viewer::Surface& read : {read_obj(folder.read("a.obj")), read_ply(folder.read("a.ply"))})
    {
        CHECK(same_bits(read.positions, surface.positions));
        CHECK(same_bits(read.normals, surface.normals));
        CHECK(read.faces.indices == surface.faces.indices);
    }
}

TEST_CASE("a point cache and the file beside it, byte for byte")
{
    const TestFolder folder;
    const fs::path path = folder / "a.pc2";
    auto cache = viewer::PointCacheWriter::create(path, {2, 24, 1.f, 0.5f});
    REQUIRE(cache);
    const std::vector<std::vector<glm::vec3>> samples = {
        {{1, 2, 3}, {4, 5, 6}}, {{-1, 0.1f, 1e-45f}, {7, 8, 9}}, {{0, -0.f, 0}, {1, 1, 1}}};
    for (const auto& sample : samples)
        REQUIRE(cache.value().append(sample));
    CHECK(cache.value().samples() == 3);
    CHECK_FALSE(fs::exists(path)); // it is not complete
    REQUIRE(cache.value().finish());

    std::string bytes = folder.read("a.pc2");
    REQUIRE(bytes.size() == 32 + 3 * 2 * 12);
    CHECK(bytes.substr(0, 12) == std::string("POINTCACHE2\0", 12));
    bytes.erase(0, 12);
    CHECK(take<int32_t>(bytes) == 1);
    CHECK(take<int32_t>(bytes) == 2);
    CHECK(take<float>(bytes) == 1.f);
    CHECK(take<float>(bytes) == 0.5f);
    CHECK(take<int32_t>(bytes) == 3);
    for (const auto& sample : samples)
    {
        const std::vector<glm::vec3> read = {take<glm::vec3>(bytes), take<glm::vec3>(bytes)};
        CHECK(same_bits(read, sample));
    }
    CHECK(folder.read("a.pc2.json") ==
          "{\"frames_per_second\": 24, \"start_frame\": 1, \"samples\": 3, \"vertices\": 2}\n");
    CHECK(folder.entries() == 2);
}

TEST_CASE("an unfinished or refused point cache leaves nothing behind")
{
    const TestFolder folder;
    const fs::path path = folder / "a.pc2";
    {
        auto cache = viewer::PointCacheWriter::create(path, {1});
        REQUIRE(cache);
        REQUIRE(cache.value().append(std::vector<glm::vec3>{{1, 2, 3}}));
        CHECK(error_of(cache.value().append(std::vector<glm::vec3>(2))) ==
              path.string() + ": sample 1 has 2 points instead of 1");
        CHECK(error_of(cache.value().append(std::vector<glm::vec3>{{0, k_nan, 0}})) ==
              path.string() + ": sample 1 is not written: the position of vertex 0 is not finite");
        CHECK(cache.value().samples() == 1);
        viewer::PointCacheWriter moved = std::move(cache.value());
        REQUIRE(moved.append(std::vector<glm::vec3>{{1, 2, 3}}));
    }
    CHECK(folder.entries() == 0);
    auto cache = viewer::PointCacheWriter::create(path, {0});
    REQUIRE(cache);
    REQUIRE(cache.value().finish());
    CHECK_FALSE(cache.value().finish()); // it is finished already
    CHECK(folder.read("a.pc2").size() == 32);
}

TEST_CASE("one cloth goes into the named file, several into files with their names")
{
    using Paths = std::vector<fs::path>;
    CHECK(viewer::export_paths("d/out.obj", {"sheet"}) == Paths{"d/out.obj"});
    CHECK(viewer::export_paths("d/out.obj", {"sheet", "flag"}) == Paths{"d/out_sheet.obj", "d/out_flag.obj"});
    CHECK(viewer::export_paths("out.v2.ply", {"a/b", "a:b", "a b"}) ==
          Paths{"out.v2_a_b.ply", "out.v2_a_b_2.ply", "out.v2_a_b_3.ply"});
    CHECK(viewer::export_paths("out.obj", {}).empty());

    const TestFolder folder;
    const auto written =
        viewer::export_surfaces(folder / "out.OBJ", {triangle("sheet"), triangle("flag"), triangle("flag")});
    REQUIRE_MESSAGE(written, written.error().message);
    REQUIRE(written.value().size() == 3);
    CHECK(written.value()[2] == folder / "out_flag_2.OBJ");
    CHECK(folder.read("out_sheet.OBJ").find("\no sheet\n") != std::string::npos);
    CHECK(folder.entries() == 3);
    REQUIRE(viewer::export_surfaces(folder / "one.ply", {triangle("sheet")}));
    CHECK(folder.read("one.ply").starts_with("ply\n"));
    CHECK(error_of(viewer::export_surfaces("a.stl", {triangle("sheet")})) == "a.stl: does not end in .obj or .ply");
}

TEST_CASE("unsound surfaces are refused, and no cloth is written")
{
    const TestFolder folder;
    const std::string file = (folder / "a.obj").string();
    const auto refused = [&](const viewer::Surface& surface)
    {
        CHECK_FALSE(viewer::save_surface_ply(folder / "a.ply", surface));
        return error_of(viewer::save_surface_obj(file, surface));
    };
    const std::string cloth = file + ": \"sheet\" ";
    viewer::Surface surface = triangle("sheet");
    for (const float value : {k_nan, k_infinity, -k_infinity})
    {
        surface.positions[2].z = value;
        CHECK(refused(surface) == cloth + "is not written: the position of vertex 2 is not finite");
    }
    CHECK_FALSE(viewer::export_surfaces(file, {triangle("first"), surface}));
    surface = triangle("sheet");
    surface.normals.assign(3, {0, 1, 0});
    surface.normals[1].x = k_nan;
    CHECK(refused(surface) == cloth + "is not written: the normal of vertex 1 is not finite");
    surface.normals.pop_back();
    CHECK(refused(surface) == cloth + "has 2 normals for 3 vertices");
    surface = triangle("sheet");
    surface.faces.indices.insert(surface.faces.indices.end(), {0, 3, 1});
    CHECK(refused(surface) == cloth + "has face 1 with an index beyond its 3 vertices");
    surface = triangle("sheet");
    surface.texture_coordinates.resize(2);
    CHECK(refused(surface) == cloth + "has 2 texture coordinates for 3 vertices");
    surface.faces.texture_indices = {0, 1, 2};
    CHECK(refused(surface) == cloth + "has face 0 with an index beyond its 2 texture coordinates");
    surface.faces.texture_indices = {0};
    CHECK(refused(surface) == cloth + "has texture coordinates for 1 corners of 3");
    CHECK(folder.entries() == 0);
}

TEST_CASE("a file that cannot be written is named with the reason, and nothing is left behind")
{
    const TestFolder folder;
    const fs::path missing = folder / "missing" / "a.obj";
    CHECK(error_of(viewer::save_surface_obj(missing, triangle("a"))) ==
          missing.string() + ": cannot be written: there is no folder " + missing.parent_path().string());
    CHECK_FALSE(viewer::PointCacheWriter::create(missing, {1}));
    CHECK(error_of(viewer::save_surface_obj(folder.path(), triangle("a"))) ==
          folder.path().string() + ": cannot be written: it is a folder");
    CHECK(folder.entries() == 0);
    if (::geteuid() != 0) // whom permissions do not stop
    {
        fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
        CHECK(error_of(viewer::save_surface_ply(folder / "a.ply", triangle("a"))) ==
              (folder / "a.ply").string() + ": cannot be written: Permission denied");
        fs::permissions(folder.path(), fs::perms::owner_all);
        CHECK(folder.entries() == 0);
    }
    const std::string long_name(300, 'n');
    CHECK(error_of(viewer::save_surface_obj(folder / (long_name + ".obj"), triangle("a")))
              .ends_with(": cannot be written: File name too long"));
}

TEST_CASE("a full disk is reported, and the old file is kept")
{
    if (fs::is_character_file("/dev/full"))
        CHECK(error_of(viewer::save_surface_obj("/dev/full", triangle("a"))) ==
              "/dev/full: cannot be written: No space left on device");
    const TestFolder folder;
    folder.write("a.obj", "before");
    viewer::Surface bad = triangle("a");
    bad.positions[0].x = k_nan;
    CHECK_FALSE(viewer::save_surface_obj(folder / "a.obj", bad));
    CHECK(folder.read("a.obj") == "before");
    // A link is followed, not replaced.
    fs::create_symlink("a.obj", folder / "link.obj");
    REQUIRE(viewer::save_surface_obj(folder / "link.obj", triangle("a")));
    CHECK(fs::is_symlink(folder / "link.obj"));
    CHECK(folder.read("a.obj").starts_with("# meters"));
}
