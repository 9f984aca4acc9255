// Whole files in and out. C streams, because they leave the reason of a failure in errno.
#include "engine/assets/file.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace engine
{

namespace
{

struct CloseFile
{
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

gpu::Error error_of(const std::filesystem::path& path, const std::string& what, int code)
{
    return gpu::Error{path.string() + ": " + what + ": " + std::generic_category().message(code)};
}

// True if every byte has reached the file; errno says why not.
bool write_all(const std::filesystem::path& path, std::string_view bytes)
{
    File file(std::fopen(path.c_str(), "wb"));
    if (!file)
        return false;
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
    const int code = errno;
    const bool closed = std::fclose(file.release()) == 0; // a full disk may show only here
    if (!written)
        errno = code;
    return written && closed;
}

} // namespace

gpu::Result<std::string> read_file(const std::filesystem::path& path)
{
    std::error_code ignored; // a path that cannot be looked at fails to open just below, with the reason
    if (std::filesystem::is_directory(path, ignored))
        return error_of(path, "cannot read", EISDIR);
    const File file(std::fopen(path.c_str(), "rb"));
    if (!file)
        return error_of(path, "cannot read", errno);
    std::string bytes;
    std::array<char, 65536> chunk;
    while (const size_t count = std::fread(chunk.data(), 1, chunk.size(), file.get()))
        bytes.append(chunk.data(), count);
    if (std::ferror(file.get()) != 0)
        return error_of(path, "cannot read", errno);
    return bytes;
}

gpu::Result<void> write_file(const std::filesystem::path& path, std::string_view bytes)
{
    // The process in the name keeps two writers of the same file out of each other's way.
    std::filesystem::path part = path;
    part += "." + std::to_string(getpid()) + ".part";
    std::error_code ignored;
    if (!write_all(part, bytes))
    {
        const int code = errno;
        std::filesystem::remove(part, ignored);
        return error_of(path, "cannot write", code);
    }
    std::error_code failure;
    std::filesystem::rename(part, path, failure);
    if (failure)
    {
        std::filesystem::remove(part, ignored);
        return error_of(path, "cannot write", failure.value());
    }
    return {};
}

} // namespace engine
