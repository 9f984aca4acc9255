// AnimationExports: the exports that grow with every frame: point caches and USD.
#pragma once

#include "samples/viewer/export_scene.hpp"
#include "samples/viewer/outcome.hpp"
#include "samples/viewer/point_cache.hpp"

namespace viewer
{

class AnimationExports
{
public:
    // Starts the files with the state before the first step. `scene` is borrowed. Errors name the file.
    static voile::Result<AnimationExports> create(voile::engine::App& app, const Stage& stage, const ExportScene& scene,
                                                  const SceneFile& file, const Options& options);

    // Records the copy of this frame's positions; after the cloth's passes, outside rendering.
    void record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame) const;

    // Appends a frame that the device has finished.
    voile::Result<void> write(const voile::engine::FrameInfo& frame);

    // Completes all files; one that fails does not keep the others from it.
    void finish(Outcome& outcome);

private:
    struct Cache
    {
        PointCacheWriter writer;
        std::filesystem::path path;
        size_t object;
    };
    struct Animation
    {
        UsdWriter writer;
        std::filesystem::path path;
    };
    AnimationExports(voile::engine::App& app, const Stage& stage, const ExportScene& scene)
        : app_(&app), stage_(&stage), scene_(&scene)
    {
    }
    voile::Result<void> add_caches(const std::filesystem::path& path, size_t objects, double rate);
    voile::Result<void> add_animation(const std::filesystem::path& path, const SceneFile& file);
    voile::Result<void> add_readback();
    [[nodiscard]] std::vector<glm::vec3> positions(size_t object, const voile::engine::FrameInfo& frame,
                                                   double seconds) const;
    voile::Result<void> append(size_t object, const std::vector<glm::vec3>& positions, const glm::mat4& pose);

    voile::engine::App* app_;
    const Stage* stage_;
    const ExportScene* scene_;
    std::vector<Cache> caches_;
    std::vector<Animation> animations_;
    std::vector<voile::gpu::Buffer> readback_; // positions of all cloths, one per slot
};

} // namespace viewer
