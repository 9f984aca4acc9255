// Frames as an H.264 film (MP4), encoded by an ffmpeg that runs beside the program and reads them from a socket.
#pragma once

#include "voile/engine/assets/atomic_file.hpp"
#include "voile/result.hpp"

#include <sys/types.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace viewer
{

struct FilmSettings
{
    uint32_t width = 0; // pixels; an odd size is padded by one, for 4:2:0 needs even ones
    uint32_t height = 0;
    double rate = 60;               // frames per second, > 0
    std::string program = "ffmpeg"; // looked up in PATH, started directly and not by a shell
};

class FilmWriter
{
public:
    // Starts the encoder. Errors: no ffmpeg, a size or rate of zero, a folder that is not there.
    static voile::Result<FilmWriter> create(const std::filesystem::path& path, const FilmSettings& settings);

    ~FilmWriter(); // without finish(), the encoder is stopped and nothing is left behind
    FilmWriter(FilmWriter&& other) noexcept;
    FilmWriter& operator=(FilmWriter&&) = delete;
    FilmWriter(const FilmWriter&) = delete;
    FilmWriter& operator=(const FilmWriter&) = delete;

    // One frame: width * height * 4 bytes, rows from the top, sRGB; alpha is dropped. Blocks while the encoder is busy.
    // Errors: another number of bytes; what the encoder said when it left early.
    voile::Result<void> add(std::span<const uint8_t> rgba);

    // Waits for the encoder and gives the film its name. An error without any frame.
    voile::Result<void> finish();

private:
    FilmWriter() = default;
    voile::Error encoder_error();
    int wait_for_encoder();
    void discard() noexcept;

    std::filesystem::path path_;             // as asked for, for messages
    std::filesystem::path target_;           // links followed
    voile::engine::TemporaryFile temporary_; // what ffmpeg writes
    size_t frame_bytes_ = 0;
    uint64_t frames_ = 0;
    pid_t encoder_ = -1;
    std::unique_ptr<voile::engine::Cleanup> encoder_cleanup_; // a signal that ends the program ends the encoder first
    int socket_ = -1;
    std::FILE* messages_ = nullptr; // an unnamed file that takes the encoder's standard error
};

} // namespace viewer
