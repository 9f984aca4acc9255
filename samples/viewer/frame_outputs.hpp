// FrameOutputs: the files that grow with every frame: pictures, a film, point caches.
#pragma once

#include "samples/viewer/exports.hpp"
#include "samples/viewer/film.hpp"
#include "samples/viewer/options.hpp"
#include "samples/viewer/stage.hpp"

#include "voile/engine/render/readback.hpp"

#include <optional>

namespace viewer
{

// What a run has written, for people, and the first thing that it could not write.
struct Outcome
{
    std::vector<std::string> written;
    std::optional<voile::Error> failure;

    void add(const voile::Result<void>& result, std::string what);
};

// A path as `written` has it.
std::string written_name(const std::filesystem::path& path);

class FrameOutputs
{
public:
    // Makes the folder, starts the encoder. Errors name the file or folder that cannot be written.
    static voile::Result<FrameOutputs> create(voile::engine::App& app, const Stage& stage, const SceneFile& scene,
                                              const Options& options);

    // Records the copies that this frame's files need; after drawing, outside rendering.
    void record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame) const;

    // Writes what belongs to a frame that the device has finished.
    voile::Result<void> write(const voile::engine::FrameInfo& frame);

    // Completes the film and the caches; what fails does not keep the others from it.
    void finish(Outcome& outcome);

    // Whether the frame's picture goes to a file.
    [[nodiscard]] bool wants_picture(const voile::engine::FrameInfo& frame) const;

private:
    FrameOutputs() = default;
    voile::Result<void> create_caches(voile::engine::App& app, const Stage& stage, const Options& options);

    voile::engine::App* app_ = nullptr;
    std::optional<std::filesystem::path> folder_;
    uint32_t every_ = 1;
    uint32_t pictures_written_ = 0;
    std::optional<voile::engine::Readback> pictures_;
    std::optional<std::filesystem::path> film_path_;
    std::optional<FilmWriter> film_;

    struct Cache
    {
        PointCacheWriter writer;
        std::filesystem::path path;
        voile::ClothId cloth;
    };
    const voile::Solver* solver_ = nullptr;
    std::vector<Cache> caches_;
    std::vector<voile::gpu::Buffer> positions_; // one per slot, of all cloths; empty without caches
};

} // namespace viewer
