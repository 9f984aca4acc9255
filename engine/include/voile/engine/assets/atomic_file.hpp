// A file that appears under its name only when it is complete. It is written next to its name and renamed at the end.
// If a signal ends the program, the unfinished file is removed (cleanup.hpp).
#pragma once

#include "voile/engine/assets/cleanup.hpp"
#include "voile/result.hpp"

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace voile::engine
{

// The temporary name of a file until it is complete, in the same folder, so that the rename is atomic. The destructor
// removes a file of that name.
class TemporaryFile
{
public:
    TemporaryFile() = default; // no name
    explicit TemporaryFile(const std::filesystem::path& target);
    ~TemporaryFile() { remove(); }
    TemporaryFile(TemporaryFile&& other) noexcept;
    TemporaryFile& operator=(TemporaryFile&& other) noexcept;
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    void remove() noexcept;
    // Renames the file to `target` and replaces an existing file. Errors name the target.
    Result<void> complete(const std::filesystem::path& target);

private:
    std::filesystem::path path_;
    std::unique_ptr<Cleanup> cleanup_;
};

// Follows symbolic links, so that the file that a link points to is replaced and not the link. Errors name the path.
Result<std::filesystem::path> resolve_target(const std::filesystem::path& path);

class AtomicFile
{
public:
    // Errors name the file and the system's reason. A special file (/dev/stdout) is written directly.
    static Result<AtomicFile> create(const std::filesystem::path& path);

    ~AtomicFile(); // without commit(), nothing is left behind
    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    // Writing after a failure does nothing. commit() reports the first failure.
    void write(const void* data, size_t size);
    void write(std::string_view text) { write(text.data(), text.size()); }
    void seek(long offset);

    // False once a write has failed.
    [[nodiscard]] bool good() const { return failure_ == 0; }

    Result<void> commit();

private:
    AtomicFile() = default;
    void discard() noexcept;

    std::filesystem::path path_;   // as the caller gave it, for messages
    std::filesystem::path target_; // links followed
    TemporaryFile temporary_;      // no name if the target is written directly
    std::FILE* file_ = nullptr;
    int failure_ = 0; // errno of the first failure
};

} // namespace voile::engine
