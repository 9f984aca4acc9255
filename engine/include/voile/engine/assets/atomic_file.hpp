// A file that appears under its name only when it is complete: it is written beside it and renamed at the end. A signal
// that ends the program removes what is unfinished (cleanup.hpp).
#pragma once

#include "voile/engine/assets/cleanup.hpp"
#include "voile/gpu/result.hpp"

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace voile::engine
{

// The name that a file is written under until it is complete: in the same folder, so that the renaming is atomic. What
// has that name is removed with the object.
class TemporaryFile
{
public:
    TemporaryFile() = default; // without a name
    explicit TemporaryFile(const std::filesystem::path& target);
    ~TemporaryFile() { remove(); }
    TemporaryFile(TemporaryFile&& other) noexcept;
    TemporaryFile& operator=(TemporaryFile&& other) noexcept;
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    void remove() noexcept;
    // Gives it the target's name; what had that name before is replaced. Errors name the target.
    gpu::Result<void> complete(const std::filesystem::path& target);

private:
    std::filesystem::path path_;
    std::unique_ptr<Cleanup> cleanup_;
};

// A symbolic link is followed, so that the file it points to is replaced and not the link. Errors name the path.
gpu::Result<std::filesystem::path> resolve_target(const std::filesystem::path& path);

class AtomicFile
{
public:
    // Errors name the file and the system's reason. What is no regular file (/dev/stdout) is written directly.
    static gpu::Result<AtomicFile> create(const std::filesystem::path& path);

    ~AtomicFile(); // without commit(), nothing is left behind
    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    // Writing after a failure does nothing; commit() reports the first one.
    void write(const void* data, size_t size);
    void write(std::string_view text) { write(text.data(), text.size()); }
    void seek(long offset);

    // False once something could not be written.
    [[nodiscard]] bool good() const { return failure_ == 0; }

    gpu::Result<void> commit();

private:
    AtomicFile() = default;
    void discard() noexcept;

    std::filesystem::path path_;   // as it was asked for, for messages
    std::filesystem::path target_; // links followed
    TemporaryFile temporary_;      // without a name: written directly
    std::FILE* file_ = nullptr;
    int failure_ = 0; // errno of the first failure
};

} // namespace voile::engine
