// What is drawn besides the shaded scene: the overlay, wires, and the heat map of strain.
#include "support/gpu_fixture.hpp"

#include "voile/engine/render/overlay.hpp"
#include "voile/engine/render/readback.hpp"
#include "voile/engine/render/renderer.hpp"
#include "voile/engine/scene/static_mesh.hpp"

#include <array>
#include <functional>

namespace
{

constexpr VkExtent2D k_extent{64, 64};

class Pictures : public tests::GpuFixture
{
public:
    Pictures()
        : uploads(tests::device().context()),
          renderer(tests::device(), {.extent = k_extent, .slots = 1, .shadow_resolution = 64}),
          readback_(tests::device(), k_extent, 1)
    {
        scene.camera = {.position = {0, 0, 4}, .target = {0, 0, 0}, .fov = 53.13f}; // 4 m of the plane z = 0
        scene.focus = {0, 0, 0};
        scene.sun.direction = {0, 0, -1};
    }

    voile::engine::Picture draw()
    {
        run(
            [&](VkCommandBuffer cmd)
            {
                uploads.record(cmd);
                renderer.record(cmd, scene, {});
                if (over)
                    over(cmd);
                readback_.record(cmd, renderer.color(), 0);
            });
        return readback_.picture(0);
    }

    // A square of fabric of 2 m that is `stretch` times as wide as it was made.
    void add_square(float stretch)
    {
        voile::engine::Mesh mesh;
        mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
        mesh.normals.assign(4, {0, 0, 1});
        for (const glm::vec3& p : mesh.positions)
            mesh.texture_coordinates.emplace_back(p.x / stretch, p.y);
        mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
        voile::engine::Surface surface;
        surface.kind = voile::engine::Surface::Kind::fabric;
        scene.add("square").add<voile::engine::StaticMesh>(uploads, mesh, surface);
    }

    voile::engine::Scene scene;
    voile::engine::UploadBatch uploads;
    voile::engine::Renderer renderer;
    std::function<void(VkCommandBuffer)> over;

private:
    voile::engine::Readback readback_;
};

glm::ivec3 pixel(const voile::engine::Picture& picture, uint32_t x, uint32_t y)
{
    const uint8_t* p = &picture.rgba[size_t{4} * (size_t{y} * picture.width + x)];
    return {p[0], p[1], p[2]};
}

// A square of 32 x 32 pixels. Its left half is covered, its right half is not.
voile::engine::OverlayTriangles red_square()
{
    constexpr uint32_t k_red = 0xff0000ff;
    voile::engine::OverlayTriangles triangles;
    triangles.vertices = {{{0, 0}, {0.25f, 0.5f}, k_red},
                          {{32, 0}, {0.25f, 0.5f}, k_red},
                          {{0, 32}, {0.25f, 0.5f}, k_red},
                          {{32, 32}, {0.25f, 0.5f}, k_red}};
    triangles.indices = {0, 1, 2, 1, 3, 2};
    triangles.parts = {{{{8, 8}, {16, 100}}, 0, 6, 0}};
    return triangles;
}

} // namespace

TEST_CASE_FIXTURE(Pictures, "an overlay draws in pixels, within its scissors, as its image covers it")
{
    const std::array<std::byte, 2> texels{std::byte{255}, std::byte{0}};
    voile::engine::Overlay overlay(tests::device(), 1, renderer.color().format(), {texels, {2, 1}});
    voile::engine::OverlayTriangles triangles = red_square();
    const voile::engine::Picture plain = draw();
    over = [&](VkCommandBuffer cmd) { overlay.record(cmd, renderer.color(), 0, triangles); };
    const voile::engine::Picture drawn = draw();
    CHECK(pixel(drawn, 8, 8) == glm::ivec3(255, 0, 0));
    CHECK(pixel(drawn, 23, 31) == glm::ivec3(255, 0, 0));
    for (const glm::uvec2& outside : {glm::uvec2(7, 8), glm::uvec2(24, 20), glm::uvec2(8, 7), glm::uvec2(10, 32)})
        CHECK(pixel(drawn, outside.x, outside.y) == pixel(plain, outside.x, outside.y));

    for (voile::engine::OverlayVertex& vertex : triangles.vertices)
        vertex.coordinate.x = 0.75f; // not covered
    CHECK(draw().rgba == plain.rgba);
    triangles = {};
    CHECK(draw().rgba == plain.rgba);
}

TEST_CASE_FIXTURE(Pictures, "wires show the edges of triangles and nothing else")
{
    add_square(1);
    const voile::engine::Picture plain = draw();
    if (!tests::device().draws_wires())
    {
        MESSAGE("skipped: the device draws no wires");
        return;
    }
    renderer.modes.wires = true;
    const voile::engine::Picture wires = draw();
    // The square fills the middle half of the picture; its diagonal goes from the lower right to the upper left corner.
    CHECK(pixel(wires, 32, 32).g < pixel(plain, 32, 32).g / 2 + 20);
    CHECK(pixel(wires, 24, 40) == pixel(plain, 24, 40));
    CHECK(pixel(wires, 4, 4) == pixel(plain, 4, 4));
    renderer.modes.wires = false;
    CHECK(draw().rgba == plain.rgba);
}

TEST_CASE("the heat map is blue for fabric at rest and red at the given strain")
{
    std::vector<glm::ivec3> colors;
    for (const float stretch : {1.f, 1.05f, 1.1f, 1.4f})
    {
        Pictures pictures;
        pictures.add_square(stretch);
        pictures.renderer.modes.full_strain = 0.1f;
        colors.push_back(pixel(pictures.draw(), 24, 40));
    }
    CHECK(colors[0].b > 2 * colors[0].r);
    CHECK(colors[1].g > colors[1].b);
    CHECK(colors[2].r > 2 * colors[2].b);
    CHECK(colors[2].r > 2 * colors[2].g);
    CHECK(colors[3].r > 2 * colors[3].g); // and no hotter
}
