// PictureSaver: writes the picture of a frame as PNG when the user asks for it.
#pragma once

#include "voile/engine/app/app.hpp"
#include "voile/engine/render/readback.hpp"

#include <filesystem>
#include <optional>

namespace viewer
{

class PictureSaver
{
public:
    explicit PictureSaver(voile::engine::App& app) : app_(app) {}

    // The next frame's picture goes to this file.
    void request(std::filesystem::path path) { requested_ = std::move(path); }

    // Records the copy, if one is due; after drawing, outside rendering.
    void record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame);
    // Writes the picture of a frame that the device has finished. The path, if the frame had one.
    voile::Result<std::optional<std::filesystem::path>> write(const voile::engine::FrameInfo& frame);

private:
    struct Pending
    {
        voile::engine::Readback readback;
        uint32_t slot;
        std::filesystem::path path;
    };

    voile::engine::App& app_;
    std::optional<std::filesystem::path> requested_;
    std::optional<Pending> pending_;
};

// The first of STEM_1.EXTENSION, STEM_2.EXTENSION ... in the folder that does not exist.
std::filesystem::path unused_path(const std::filesystem::path& folder, const std::string& stem,
                                  const std::string& extension);

} // namespace viewer
