// A file that appears under its name only when it is complete: it is written beside it and renamed at the end.
#pragma once

#include "gpu/result.hpp"

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace viewer
{

// The name that `target` is written under until it is complete: in the same folder, so that the renaming is atomic.
std::filesystem::path temporary_name(const std::filesystem::path& target);

// A symbolic link is followed, so that the file it points to is replaced and not the link. Errors name the path.
gpu::Result<std::filesystem::path> resolve_target(const std::filesystem::path& path);

gpu::Result<void> rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

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

    std::filesystem::path path_;      // as it was asked for, for messages
    std::filesystem::path target_;    // links followed
    std::filesystem::path temporary_; // empty: written directly
    std::FILE* file_ = nullptr;
    int failure_ = 0; // errno of the first failure
};

} // namespace viewer
