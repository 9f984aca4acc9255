// Writing OBJ.
#include "voile/engine/assets/obj.hpp"

#include "support/test_folder.hpp"
#include "voile/engine/assets/shapes.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <random>
#include <string>

TEST_CASE("a mesh survives a round trip through OBJ with every float and index")
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-10.f, 10.f);
    voile::engine::Mesh mesh;
    for (uint32_t i = 0; i < 3000; i += 3)
    {
        for (int corner = 0; corner < 3; ++corner)
            mesh.positions.emplace_back(any(random), any(random) * 1e-3f, any(random));
        mesh.triangles.emplace_back(i + 2, i, i + 1);
    }
    const TestFolder folder;
    REQUIRE(voile::engine::save_obj(folder / "a.obj", mesh));
    const auto loaded = voile::engine::load_obj(folder / "a.obj");
    REQUIRE(loaded);
    CHECK(loaded.value().positions == mesh.positions);
    CHECK(loaded.value().triangles == mesh.triangles);
}

TEST_CASE("an invalid mesh is not saved")
{
    const TestFolder folder;
    const std::string path = (folder / "a.obj").string();
    voile::engine::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 3}};
    CHECK(voile::engine::save_obj(path, mesh).error().message == path + ": triangle 0 refers to position 3 of 3");
    mesh.triangles = {{0, 1, 2}};
    mesh.positions[1].y = std::numeric_limits<float>::quiet_NaN();
    CHECK(voile::engine::save_obj(path, mesh).error().message == path + ": position 1 is not finite");
    CHECK(folder.is_empty());
}

TEST_CASE("a mesh that cannot be written leaves nothing behind")
{
    const TestFolder folder;
    const voile::engine::Mesh mesh = voile::engine::make_ground(1.f);
    const std::string nowhere = (folder / "gone/a.obj").string();
    CHECK(voile::engine::save_obj(nowhere, mesh).error().message ==
          nowhere + ": cannot be written: there is no folder " + (folder / "gone").string());
    CHECK(folder.is_empty());

    const std::string below_file = folder.write("file", "").string() + "/a.obj";
    CHECK(voile::engine::save_obj(below_file, mesh).error().message ==
          below_file + ": cannot be written: there is no folder " + (folder / "file").string());
    std::filesystem::remove(folder / "file");

    std::filesystem::create_directory(folder / "a.obj"); // occupies the path
    const std::string taken = (folder / "a.obj").string();
    CHECK(voile::engine::save_obj(taken, mesh).error().message == taken + ": cannot be written: it is a folder");
    std::filesystem::remove(folder / "a.obj");
    CHECK(folder.is_empty());
}

TEST_CASE("saving replaces the file and leaves nothing else")
{
    const TestFolder folder;
    const std::string path = folder.write("a.obj", "old").string();
    REQUIRE(voile::engine::save_obj(path, voile::engine::make_ground(1.f)));
    CHECK(voile::engine::load_obj(path).has_value());
    std::filesystem::remove(path);
    CHECK(folder.is_empty());
}
