// USD text: every character of a small file. check_usd.py reads files with Pixar's library where it is installed.
#include "samples/viewer/usd_writer.hpp"
#include "support/test_folder.hpp"

#include <doctest/doctest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <limits>
#include <string>
#include <vector>

namespace
{

viewer::Surface triangle(const std::string& name)
{
    return {name, {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}}, {}, {}, {3, {0, 1, 2}, {}}};
}

const char* const k_expected = R"(#usda 1.0
(
    defaultPrim = "_2_scenes"
    startTimeCode = 0
    endTimeCode = 1
    timeCodesPerSecond = 24
    framesPerSecond = 24
    metersPerUnit = 1
    upAxis = "Y"
)

def Xform "_2_scenes"
{
    def Mesh "sheet"
    {
        uniform token subdivisionScheme = "none"
        uniform token orientation = "rightHanded"
        uniform bool doubleSided = 1
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        texCoord2f[] primvars:st = [(0, 0), (1, 0.5)] (
            interpolation = "faceVarying"
        )
        int[] primvars:st:indices = [0, 1, 1]
        point3f[] points.timeSamples = {
            0: [(0, 0, 0), (1, 0, 0), (0, 0, -1)],
            1: [(0, 0, 0), (0, 2, 0), (-1, 0, 0)],
        }
        float3[] extent.timeSamples = {
            0: [(0, 0, -1), (1, 0, 0)],
            1: [(-1, 0, 0), (0, 2, 0)],
        }
        normal3f[] normals (
            interpolation = "vertex"
        )
        normal3f[] normals.timeSamples = {
            0: [(0, 1, 0), (0, 1, 0), (0, 1, 0)],
            1: [(0, 0, 1), (0, 0, 1), (0, 0, 1)],
        }
    }
    def Mesh "sheet_2"
    {
        uniform token subdivisionScheme = "none"
        uniform token orientation = "rightHanded"
        uniform bool doubleSided = 0
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (0, 1)] (
            interpolation = "vertex"
        )
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 0, -1)]
        float3[] extent = [(0, 0, -1), (1, 0, 0)]
        matrix4d xformOp:transform.timeSamples = {
            0: ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1) ),
            1: ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (3, 4, 5, 1) ),
        }
        uniform token[] xformOpOrder = ["xformOp:transform"]
    }
    def Mesh "a_b_" (
        customData = {
            string name = "a\"b\\"
        }
    )
    {
        uniform token subdivisionScheme = "none"
        uniform token orientation = "rightHanded"
        uniform bool doubleSided = 0
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 0, -1)]
        float3[] extent = [(0, 0, -1), (1, 0, 0)]
        normal3f[] normals = [(0, 1, 0), (0, 1, 0), (0, 1, 0)] (
            interpolation = "vertex"
        )
    }
}
)";

} // namespace

TEST_CASE("a USD file, character for character")
{
    const TestFolder folder;
    using viewer::SurfaceMotion;
    std::vector<viewer::UsdMesh> meshes = {{triangle("sheet"), SurfaceMotion::deforming, true},
                                           {triangle("sheet"), SurfaceMotion::rigid},
                                           {triangle("a\"b\\"), SurfaceMotion::still}};
    meshes[0].surface.texture_coordinates = {{0, 0}, {1, 0.5f}};
    meshes[0].surface.faces.texture_indices = {0, 1, 1};
    meshes[1].surface.texture_coordinates = {{0, 0}, {1, 0}, {0, 1}};
    meshes[2].surface.normals.assign(3, {0, 1, 0});
    auto writer = viewer::UsdWriter::create(folder / "a.usda", {"2 scenes", 24}, meshes);
    REQUIRE(writer);
    REQUIRE(writer.value().append(0, std::vector<glm::vec3>{{0, 0, 0}, {0, 2, 0}, {-1, 0, 0}}));
    writer.value().append(1, glm::translate(glm::mat4(1), {3, 4, 5}));
    CHECK_FALSE(std::filesystem::exists(folder / "a.usda"));
    REQUIRE(writer.value().finish());
    std::string text = folder.read("a.usda");
    // The second "sheet" has another name than its prim.
    const std::string renamed = " (\n        customData = {\n            string name = \"sheet\"\n        }\n    )";
    REQUIRE(text.find(renamed) != std::string::npos);
    text.erase(text.find(renamed), renamed.size());
    CHECK(text == k_expected);
}

TEST_CASE("an unfinished or refused USD file leaves nothing behind")
{
    const TestFolder folder;
    const std::string file = (folder / "a.usda").string();
    {
        auto writer = viewer::UsdWriter::create(file, {}, {{triangle("sheet"), viewer::SurfaceMotion::deforming}});
        REQUIRE(writer);
        CHECK(folder.entries() == 2); // the file, and the samples
        const auto few = writer.value().append(0, std::vector<glm::vec3>(2));
        REQUIRE_FALSE(few);
        CHECK(few.error().message == file + ": sample 1 of \"sheet\" has 2 points instead of 3");
        const float nan = std::numeric_limits<float>::quiet_NaN();
        CHECK_FALSE(writer.value().append(0, std::vector<glm::vec3>{{0, 0, 0}, {0, nan, 0}, {0, 0, 1}}));
    }
    CHECK(folder.entries() == 0);
    viewer::Surface bad = triangle("sheet");
    bad.faces.indices[0] = 7;
    CHECK_FALSE(viewer::UsdWriter::create(file, {}, {{bad}}));
    const auto nowhere = viewer::UsdWriter::create(folder / "no/a.usda", {}, {{triangle("sheet")}});
    REQUIRE_FALSE(nowhere);
    CHECK(nowhere.error().message.find("cannot be written: there is no folder") != std::string::npos);
    CHECK(folder.entries() == 0);
}
