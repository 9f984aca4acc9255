// Sequences of meshes: what is read, where vertices are between two files, and what is refused.
#include "samples/viewer/frame_sequence.hpp"
#include "support/close_to.hpp"
#include "support/test_folder.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace
{

// A quad of which one corner moves, far enough to turn the shorter diagonal.
std::string quad(float x)
{
    return "v 0 0 0\nv 1 0 0\nv " + std::to_string(x) + " 0 " + std::to_string(x) + "\nv 0 0 1\nf 1 4 3 2\n";
}

std::string message(const TestFolder& folder, const char* pattern)
{
    const auto result = viewer::MeshSequence::load({folder / pattern, 10});
    return result ? "accepted" : result.error().message;
}

} // namespace

TEST_CASE("a sequence is named by its files, without their number")
{
    for (const auto& [pattern, name] :
         {std::pair("dir/walk_%04d.obj", "walk"), {"%d.ply", "frames"}, {"a%db.obj", "ab"}, {"x-%02d.obj", "x"}})
        CHECK(viewer::sequence_name({pattern, 10}) == name);
}

TEST_CASE("vertices move along straight lines from file to file and stay at the last")
{
    const TestFolder folder;
    for (const auto& [name, x] : {std::pair("w_01.obj", 0.6f), {"w_02.obj", 2.f}, {"w_03.obj", 1.f}})
        folder.write(name, quad(x));
    const auto loaded = viewer::MeshSequence::load({folder / "w_%02d.obj", 10});
    REQUIRE(loaded);
    const viewer::MeshSequence& sequence = loaded.value();
    CHECK(sequence.frames() == 3);
    CHECK(sequence.duration() == tests::close_to(0.2, 1e-7));
    CHECK(sequence.first().positions.size() == 4);
    CHECK(sequence.first().triangles.size() == 2);
    CHECK(sequence.first().normals[0] == glm::vec3(0, 1, 0));
    CHECK(sequence.bounds().min == glm::vec3(0));
    CHECK(sequence.bounds().max == glm::vec3(2, 0, 2));
    std::vector<glm::vec3> positions;
    const auto corner = [&](double seconds)
    {
        sequence.positions_at(seconds, positions);
        CHECK(positions.size() == 4);
        CHECK(positions[1] == glm::vec3(1, 0, 0));
        return positions[2].x;
    };
    CHECK(corner(-1) == 0.6f);
    CHECK(corner(0) == 0.6f);
    CHECK(corner(0.05) == tests::close_to(1.3, 1e-7));
    CHECK(corner(0.1) == tests::close_to(2, 1e-7));
    CHECK(corner(0.175) == tests::close_to(1.25, 1e-7));
    CHECK(corner(0.2) == 1.f);
    CHECK(corner(100) == 1.f);
    // In a loop the first follows the last. With a ramp of 0.2 s the first 0.1 s take 0.2 s.
    viewer::FrameSequence entry{folder / "w_%02d.obj", 10};
    entry.loop = true;
    const auto loop = viewer::MeshSequence::load(entry);
    entry.loop = false;
    entry.ramp = 0.2f;
    const auto ramped = viewer::MeshSequence::load(entry);
    REQUIRE((loop && ramped));
    CHECK(std::isinf(loop.value().duration()));
    for (const auto& [seconds, x] : {std::pair(0.05, 1.3), {0.25, 0.8}, {0.35, 1.3}, {30.05, 1.3}})
    {
        loop.value().positions_at(seconds, positions);
        CHECK(positions[2].x == tests::close_to(x, 1e-6));
    }
    for (const auto& [seconds, x] : {std::pair(0.1, 0.95), {0.2, 2.0}, {0.3, 1.0}})
    {
        ramped.value().positions_at(seconds, positions);
        CHECK(positions[2].x == tests::close_to(x, 1e-6));
    }
    CHECK(ramped.value().duration() == tests::close_to(0.3, 1e-7));
    folder.write("one_0.obj", quad(1)); // a sequence of one file does not move
    const auto one = viewer::MeshSequence::load({folder / "one_%d.obj", 10});
    REQUIRE(one);
    CHECK(one.value().duration() == 0);
    one.value().positions_at(3, positions);
    CHECK(positions[2].x == 1.f);
}

TEST_CASE("a different mesh is refused with both counts and the files' names")
{
    const TestFolder folder;
    const std::string at = (folder / "w1.obj").string();
    folder.write("w0.obj", quad(1));
    folder.write("w1.obj", "v 5 5 5\n" + quad(1));
    CHECK(message(folder, "w%d.obj") == at + ": has 5 vertices, but the first has 4 (w0.obj)");
    folder.write("w1.obj", quad(1) + "f 1 2 3\n");
    CHECK(message(folder, "w%d.obj") == at + ": has 3 triangles, but the first has 2 (w0.obj)");
    folder.write("w1.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 4 3 2 1\n");
    CHECK(message(folder, "w%d.obj") ==
          at + ": joins vertices 3 2 1 (counted from 0) where the first joins 0 3 2 (w0.obj)");
    // The same faces are the same mesh, even where one of them has lost its area.
    folder.write("w1.obj", "v 0 0 0\nv 1 0 0\nv 0 0 0\nv 0 0 0\nf 1 4 3 2\n");
    CHECK(message(folder, "w%d.obj") == "accepted");
    // A mesh beside the sequence must have its faces too.
    const auto beside = [&](const std::string& text)
    {
        const auto file = folder.write("rest.obj", text);
        const auto result = viewer::MeshSequence::load({folder / "w%d.obj", 10}, file);
        return result ? "accepted" : result.error().message;
    };
    CHECK(beside(quad(5)) == "accepted");
    CHECK(beside("v 5 5 5\n" + quad(1)) ==
          (folder / "rest.obj").string() + ": has 5 vertices, but the first has 4 (w0.obj)");
    folder.write("w1.obj", "v 0 0 0\nv 1 0\n");
    CHECK(message(folder, "w%d.obj").starts_with(at + ":2"));
    folder.write("w1.obj", quad(1));
    folder.write("w3.obj", quad(1));
    CHECK(message(folder, "w%d.obj") == (folder / "w2.obj").string() + " is missing, but w3.obj is there");
    CHECK(message(folder, "v%d.obj") == (folder / "v%d.obj").string() + ": there is no frame 0 and no frame 1");
}

TEST_CASE("a folder may hold PLY files and files of other kinds")
{
    const TestFolder folder;
    for (int i = 0; i < 12; ++i)
        folder.write('p' + std::to_string(i) + ".ply",
                     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 " +
                         std::to_string(i) + " 1\n3 0 2 1\n");
    folder.write("p12.obj", "");
    folder.write("p.ply", "");
    const auto loaded = viewer::MeshSequence::load({folder / "p%d.ply", 1});
    REQUIRE(loaded);
    CHECK(loaded.value().frames() == 12); // in the order of numbers, not of names
    std::vector<glm::vec3> positions;
    loaded.value().positions_at(10.5, positions);
    CHECK(positions[2].y == 10.5f);
}
