// PictureSaver.
#include "samples/viewer/picture_saver.hpp"

#include <utility>

namespace viewer
{

void PictureSaver::record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame)
{
    if (!requested_ || pending_)
        return;
    pending_.emplace(Pending{voile::engine::Readback(app_.device(), app_.renderer().extent(), app_.slots()), frame.slot,
                             *std::exchange(requested_, std::nullopt)});
    pending_->readback.record(cmd, app_.renderer().color(), frame.slot);
}

voile::Result<std::optional<std::filesystem::path>> PictureSaver::write(const voile::engine::FrameInfo& frame)
{
    if (!pending_ || pending_->slot != frame.slot)
        return std::optional<std::filesystem::path>{};
    const Pending done = *std::exchange(pending_, std::nullopt);
    if (auto saved = voile::engine::save_png(done.path, done.readback.picture(done.slot)); !saved)
        return saved.error();
    return std::optional(done.path);
}

std::filesystem::path unused_path(const std::filesystem::path& folder, const std::string& stem,
                                  const std::string& extension)
{
    std::error_code problem;
    for (uint32_t number = 1;; ++number)
    {
        std::filesystem::path path = folder / (stem + "_" + std::to_string(number) + extension);
        if (!std::filesystem::exists(path, problem))
            return path;
    }
}

} // namespace viewer
