// Stage: a scene that is drawn into pictures, and what tests read from them.
#pragma once

#include "support/gpu_fixture.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/engine/gpu/upload.hpp"
#include "voile/engine/render/readback.hpp"
#include "voile/engine/render/renderer.hpp"
#include "voile/engine/scene/static_mesh.hpp"

#include <cmath>

namespace tests
{

constexpr VkExtent2D k_extent{320, 180};

// A scene and its renderer. Pictures are drawn without a window.
class Stage : public GpuFixture
{
public:
    Stage()
        : uploads(device().context()), renderer(device(), {.extent = k_extent, .slots = 1, .shadow_resolution = 1024}),
          readback_(device(), k_extent, 1)
    {
    }

    voile::engine::Picture draw(uint64_t frame = 0)
    {
        run(
            [&](VkCommandBuffer cmd)
            {
                const voile::engine::FrameInfo info{.index = frame};
                uploads.record(cmd);
                scene.update(info);
                scene.record_compute(cmd, info);
                renderer.record(cmd, scene, info);
                readback_.record(cmd, renderer.color(), 0);
            });
        return readback_.picture(0);
    }

    voile::engine::Scene scene;
    voile::engine::UploadBatch uploads;
    voile::engine::Renderer renderer;

private:
    voile::engine::Readback readback_;
};

inline glm::ivec3 pixel(const voile::engine::Picture& picture, uint32_t x, uint32_t y)
{
    const uint8_t* p = &picture.rgba[size_t{4} * (size_t{y} * picture.width + x)];
    return {p[0], p[1], p[2]};
}

inline int brightness(const glm::ivec3& p)
{
    return p.r + p.g + p.b;
}

// Root mean square of the difference of all channels, from 0 to 255.
inline double difference(const voile::engine::Picture& a, const voile::engine::Picture& b)
{
    REQUIRE(a.rgba.size() == b.rgba.size());
    double sum = 0;
    for (size_t i = 0; i < a.rgba.size(); ++i)
    {
        const double d = static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]);
        sum += d * d;
    }
    return std::sqrt(sum / static_cast<double>(a.rgba.size()));
}

inline void add_ground(Stage& stage)
{
    stage.scene.add("ground").add<voile::engine::StaticMesh>(stage.uploads, voile::engine::make_ground(60),
                                                             voile::engine::ground_surface());
}

} // namespace tests
