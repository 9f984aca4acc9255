// Exports: OBJ, PLY and PC2 read back by readers of the test's own, and what must not be written.
#include "test_folder.hpp"

#include "samples/viewer/exports.hpp"

#include "engine/assets/load_mesh.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

namespace
{

using viewer::ClothSurface;

// Values that only survive with all nine digits.
ClothSurface surface(const std::string& name = "sheet")
{
    return {name,
            {{0.1f, 1.f / 3, -2e-7f}, {1, 0, 12345.678f}, {0, 1, 0}, {1, 1, 1e-30f}},
            {{0, 1, 0}, {0, 1, 0}, {0, 0.6f, 0.8f}, {0, 1, 0}},
            {{0, 1, 2}, {1, 3, 2}}};
}

std::string bytes_of(const std::filesystem::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

template <typename T>
T value_at(const std::string& bytes, size_t offset)
{
    T value;
    REQUIRE(offset + sizeof(T) <= bytes.size());
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

} // namespace

TEST_CASE("OBJ keeps the order of the vertices and every bit of their positions")
{
    const TestFolder folder;
    REQUIRE(viewer::save_surface_obj(folder / "s.obj", surface()));
    std::istringstream lines(bytes_of(folder / "s.obj"));
    std::vector<glm::vec3> positions;
    size_t faces = 0;
    for (std::string line; std::getline(lines, line);)
    {
        std::istringstream words(line);
        std::string kind;
        glm::vec3 p;
        words >> kind;
        if (kind == "v" && words >> p.x >> p.y >> p.z)
            positions.push_back(p);
        faces += kind == "f";
    }
    CHECK(positions == surface().positions);
    CHECK(faces == 2);
    CHECK(engine::load_mesh(folder / "s.obj"));
}

TEST_CASE("PLY is what its header says")
{
    const TestFolder folder;
    REQUIRE(viewer::save_surface_ply(folder / "s.ply", surface()));
    const std::string bytes = bytes_of(folder / "s.ply");
    CHECK(bytes.starts_with("ply\nformat binary_little_endian 1.0\n"));
    const size_t data = bytes.find("end_header\n") + 11;
    CHECK(bytes.size() == data + 4 * 24 + 2 * 13);
    CHECK(value_at<float>(bytes, data + 24 + 8) == 12345.678f);
    CHECK(value_at<float>(bytes, data + 2 * 24 + 16) == 0.6f); // the third normal's y
    CHECK(value_at<uint8_t>(bytes, data + 4 * 24) == 3);
    CHECK(value_at<int32_t>(bytes, data + 4 * 24 + 13 + 5) == 3); // the second face's second corner
    const auto mesh = engine::load_mesh(folder / "s.ply");
    REQUIRE(mesh);
    CHECK(mesh.value().positions == surface().positions);
}

TEST_CASE("a point cache is a header and its samples")
{
    const TestFolder folder;
    auto writer = viewer::PointCacheWriter::create(folder / "c.pc2", 4);
    REQUIRE(writer);
    CHECK_FALSE(std::filesystem::exists(folder / "c.pc2"));
    for (int i = 0; i < 3; ++i)
        REQUIRE(writer.value().append(surface().positions));
    const auto too_few = writer.value().append(std::vector<glm::vec3>(3));
    CHECK_FALSE(too_few);
    REQUIRE(writer.value().finish());
    const std::string bytes = bytes_of(folder / "c.pc2");
    CHECK(bytes.size() == 32 + 3 * 4 * 12);
    CHECK(std::memcmp(bytes.data(), "POINTCACHE2\0", 12) == 0);
    CHECK(value_at<int32_t>(bytes, 12) == 1);
    CHECK(value_at<int32_t>(bytes, 16) == 4);
    CHECK(value_at<float>(bytes, 20) == 0);
    CHECK(value_at<float>(bytes, 24) == 1);
    CHECK(value_at<int32_t>(bytes, 28) == 3);
    CHECK(value_at<float>(bytes, 32 + 2 * 48 + 12 + 8) == 12345.678f);
}

TEST_CASE("a point cache that is not finished leaves nothing behind")
{
    const TestFolder folder;
    {
        auto writer = viewer::PointCacheWriter::create(folder / "c.pc2", 4);
        REQUIRE(writer);
        REQUIRE(writer.value().append(surface().positions));
    }
    CHECK(folder.is_empty());
}

TEST_CASE("values that are not finite and indices out of range are refused, and nothing is written")
{
    const TestFolder folder;
    for (const char* file : {"s.obj", "s.ply"})
    {
        ClothSurface broken = surface();
        broken.positions[2].y = std::numeric_limits<float>::quiet_NaN();
        const auto refused = viewer::export_surfaces(folder / file, {broken});
        REQUIRE_FALSE(refused);
        CHECK(refused.error().message.find('2') != std::string::npos); // the vertex
        broken = surface();
        broken.triangles[1].z = 4;
        CHECK_FALSE(viewer::export_surfaces(folder / file, {broken}));
    }
    CHECK(folder.is_empty());
}

TEST_CASE("several cloths get a file each, named after them")
{
    const TestFolder folder;
    const auto written = viewer::export_surfaces(folder / "run.obj",
                                                 {surface("left curtain"), surface("right/curtain"), surface("flag")});
    REQUIRE(written);
    REQUIRE(written.value().size() == 3);
    for (const auto& path : written.value())
    {
        CHECK(path.parent_path() == folder.path());
        CHECK(std::filesystem::exists(path));
    }
    CHECK(written.value()[2] == folder / "run_flag.obj");
    const auto one = viewer::export_surfaces(folder / "one.obj", {surface()});
    REQUIRE(one);
    CHECK(one.value().front() == folder / "one.obj");
}

TEST_CASE("a folder that is not there is named")
{
    const TestFolder folder;
    const auto refused = viewer::save_surface_obj(folder / "nowhere/s.obj", surface());
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message.find("nowhere") != std::string::npos);
}
