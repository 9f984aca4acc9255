// FrameOutputs: the files that grow with every frame: pictures, a film, point caches.
#pragma once

#include "samples/viewer/exports.hpp"
#include "samples/viewer/film.hpp"
#include "samples/viewer/options.hpp"
#include "samples/viewer/stage.hpp"

#include "engine/render/readback.hpp"

#include <optional>

namespace viewer
{

// What a run has written, for people, and the first thing that it could not write.
struct Outcome
{
    std::vector<std::string> written;
    std::optional<gpu::Error> failure;

    void add(const gpu::Result<void>& result, std::string what);
};

// A path as `written` has it.
std::string written_name(const std::filesystem::path& path);

class FrameOutputs
{
public:
    // Makes the folder, starts the encoder. Errors name the file or folder that cannot be written.
    static gpu::Result<FrameOutputs> create(engine::App& app, const Stage& stage, const SceneFile& scene,
                                            const Options& options);

    // Records the copies that this frame's files need; after drawing, outside rendering.
    void record(VkCommandBuffer cmd, const engine::FrameInfo& frame) const;

    // Writes what belongs to a frame that the device has finished.
    gpu::Result<void> write(const engine::FrameInfo& frame);

    // Completes the film and the caches; what fails does not keep the others from it.
    void finish(Outcome& outcome);

private:
    FrameOutputs() = default;
    [[nodiscard]] bool wants_picture(const engine::FrameInfo& frame) const;
    gpu::Result<void> create_caches(engine::App& app, const Stage& stage, const Options& options);

    engine::App* app_ = nullptr;
    std::optional<std::filesystem::path> folder_;
    uint32_t every_ = 1;
    uint32_t pictures_written_ = 0;
    std::optional<engine::Readback> pictures_;
    std::optional<std::filesystem::path> film_path_;
    std::optional<FilmWriter> film_;

    struct Cache
    {
        PointCacheWriter writer;
        std::filesystem::path path;
        cloth::ClothId cloth;
    };
    const cloth::Solver* solver_ = nullptr;
    std::vector<Cache> caches_;
    std::vector<gpu::Buffer> positions_; // one a slot, of all cloths; empty without caches
};

} // namespace viewer
