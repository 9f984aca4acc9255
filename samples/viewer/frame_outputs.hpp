// FrameOutputs: the pictures of a run: PNG files and a film.
#pragma once

#include "samples/viewer/film.hpp"
#include "samples/viewer/options.hpp"
#include "samples/viewer/outcome.hpp"

#include "voile/engine/app/app.hpp"
#include "voile/engine/render/readback.hpp"

#include <optional>

namespace viewer
{

// The folder of --out, which other files may go into, too. Errors name it.
voile::Result<void> make_picture_folder(const std::filesystem::path& folder);

class FrameOutputs
{
public:
    // Starts the encoder. Errors name the file that cannot be written.
    static voile::Result<FrameOutputs> create(voile::engine::App& app, double rate, const Options& options);

    // Records the copy that this frame's files need; after drawing, outside rendering.
    void record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame);

    // Writes what belongs to a frame that the device has finished.
    voile::Result<void> write(const voile::engine::FrameInfo& frame);

    // Completes the film. In a window the last frame may turn out to be the last only now: it is pictured, too.
    void finish(Outcome& outcome);

    // Whether the frame's picture goes to a file.
    [[nodiscard]] bool wants_picture(const voile::engine::FrameInfo& frame) const;

    // The next frame is the last one of the run: it gets a picture.
    void announce_last() { next_is_last_ = true; }

private:
    FrameOutputs() = default;
    [[nodiscard]] bool wants_png(const voile::engine::FrameInfo& frame) const;
    voile::Result<void> save(uint64_t frame, const voile::engine::Picture& picture);
    voile::Result<void> save_last();

    voile::engine::App* app_ = nullptr;
    std::optional<std::filesystem::path> folder_;
    uint32_t every_ = 1;
    uint32_t pictures_written_ = 0;
    bool next_is_last_ = false;
    std::vector<bool> png_;        // one per slot: the frame there gets a picture
    std::optional<uint64_t> last_; // the last frame that was completed,
    bool last_saved_ = false;      // and whether it has a picture
    std::optional<voile::engine::Readback> pictures_;
    std::optional<std::filesystem::path> film_path_;
    std::optional<FilmWriter> film_;
};

} // namespace viewer
