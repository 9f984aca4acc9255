// Reads and writes whole files.
#include "voile/engine/assets/file.hpp"

#include "voile/engine/assets/atomic_file.hpp"
#include "voile/engine/assets/words.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace voile::engine
{

namespace
{

class Descriptor
{
public:
    explicit Descriptor(const std::filesystem::path& path)
        : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) // a pipe without a writer opens at once
    {
    }
    ~Descriptor()
    {
        if (number_ >= 0)
            ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    [[nodiscard]] int number() const { return number_; }

private:
    int number_;
};

std::string too_large(uint64_t most_bytes)
{
    return "larger than " + std::to_string(most_bytes >> 20) + " MiB";
}

// Returns why the file cannot be read, empty if it can.
std::string find_obstacle(int file, uint64_t most_bytes, struct stat& status)
{
    if (file < 0 || ::fstat(file, &status) != 0)
        return std::strerror(errno);
    if (S_ISDIR(status.st_mode))
        return std::strerror(EISDIR);
    if (!S_ISREG(status.st_mode))
        return "not a regular file";
    return static_cast<uint64_t>(status.st_size) > most_bytes ? too_large(most_bytes) : "";
}

} // namespace

Result<std::string> read_file(const std::filesystem::path& path, uint64_t most_bytes)
{
    const auto error = [&](const std::string& reason) { return Error{path_text(path) + ": cannot read: " + reason}; };
    const Descriptor file(path);
    struct stat status = {};
    if (const std::string obstacle = find_obstacle(file.number(), most_bytes, status); !obstacle.empty())
        return error(obstacle);
    // One extra byte: files of the system report no size, and other files may grow while they are read.
    std::string bytes(static_cast<size_t>(status.st_size) + 1, '\0');
    size_t size = 0;
    while (true)
    {
        const ssize_t count = ::read(file.number(), bytes.data() + size, bytes.size() - size);
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0)
            return error(std::strerror(errno));
        size += static_cast<size_t>(count);
        if (size > most_bytes)
            return error(too_large(most_bytes));
        if (count == 0)
            break;
        if (size == bytes.size())
            bytes.resize(std::max<size_t>(2 * size, 65536));
    }
    bytes.resize(size);
    return bytes;
}

Result<void> write_file(const std::filesystem::path& path, std::string_view bytes)
{
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file)
        return file.error();
    file.value().write(bytes);
    return file.value().commit();
}

} // namespace voile::engine
