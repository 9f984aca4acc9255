// TemporaryFile and AtomicFile.
#include "voile/engine/assets/atomic_file.hpp"

#include "voile/engine/assets/words.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

namespace voile::engine
{

namespace
{

namespace fs = std::filesystem;

Error file_error(const fs::path& path, const std::string& reason)
{
    return Error{path_text(path) + ": cannot be written: " + reason};
}

} // namespace

TemporaryFile::TemporaryFile(const fs::path& target)
{
    // Two writers of one target must not share a temporary file, whether they are threads or processes.
    static std::atomic<unsigned> counter{0};
    const std::string unique = std::to_string(::getpid()) + "-" + std::to_string(counter++);
    path_ = target.parent_path() / ('.' + target.filename().string() + '.' + unique + ".part");
    cleanup_ = std::make_unique<Cleanup>([name = path_.string()] { (void)::unlink(name.c_str()); });
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : path_(std::exchange(other.path_, {})), cleanup_(std::move(other.cleanup_))
{
}

TemporaryFile& TemporaryFile::operator=(TemporaryFile&& other) noexcept
{
    remove();
    path_ = std::exchange(other.path_, {});
    cleanup_ = std::move(other.cleanup_);
    return *this;
}

void TemporaryFile::remove() noexcept
{
    if (!path_.empty())
        (void)::unlink(path_.c_str());
    path_.clear();
    cleanup_.reset();
}

Result<void> TemporaryFile::complete(const fs::path& target)
{
    std::error_code problem;
    fs::rename(path_, target, problem);
    if (problem)
        return file_error(target, problem.message());
    path_.clear();
    cleanup_.reset();
    return {};
}

Result<fs::path> resolve_target(const fs::path& path)
{
    std::error_code problem;
    if (path.filename().empty() || fs::is_directory(path, problem))
        return file_error(path, "it is a folder");
    const fs::path folder = path.parent_path();
    if (!folder.empty() && !fs::is_directory(folder, problem))
        return file_error(path, "there is no folder " + path_text(folder));
    // A link to a pipe (/dev/stdout) has no target file.
    const bool is_special = fs::exists(path, problem) && !fs::is_regular_file(path, problem);
    if (is_special || !fs::is_symlink(path, problem))
        return path;
    const fs::path target = fs::weakly_canonical(path, problem);
    if (problem)
        return file_error(path, problem.message());
    return target;
}

Result<AtomicFile> AtomicFile::create(const fs::path& path)
{
    const Result<fs::path> target = resolve_target(path);
    if (!target)
        return target.error();
    AtomicFile result;
    result.path_ = path;
    result.target_ = target.value();
    std::error_code problem;
    // A device or a pipe must not be replaced by a file.
    const bool direct = fs::exists(result.target_, problem) && !fs::is_regular_file(result.target_, problem);
    if (!direct)
        result.temporary_ = TemporaryFile(result.target_);
    const fs::path& opened = direct ? result.target_ : result.temporary_.path();
    errno = 0;
    // x: never write through an existing temporary file. e: child processes do not inherit it.
    result.file_ = std::fopen(opened.c_str(), direct ? "wbe" : "wbxe");
    if (result.file_ == nullptr)
        return file_error(path, std::strerror(errno));
    return result;
}

AtomicFile::~AtomicFile()
{
    discard();
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)), target_(std::move(other.target_)), temporary_(std::move(other.temporary_)),
      file_(std::exchange(other.file_, nullptr)), failure_(other.failure_)
{
}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept
{
    if (this != &other)
    {
        discard();
        path_ = std::move(other.path_);
        target_ = std::move(other.target_);
        temporary_ = std::move(other.temporary_);
        file_ = std::exchange(other.file_, nullptr);
        failure_ = other.failure_;
    }
    return *this;
}

void AtomicFile::discard() noexcept
{
    if (file_ != nullptr)
        (void)std::fclose(std::exchange(file_, nullptr));
    temporary_.remove();
}

void AtomicFile::write(const void* data, size_t size)
{
    if (failure_ != 0 || file_ == nullptr || size == 0)
        return;
    errno = 0;
    if (std::fwrite(data, 1, size, file_) != size)
        failure_ = errno != 0 ? errno : EIO;
}

void AtomicFile::seek(long offset)
{
    if (failure_ != 0 || file_ == nullptr)
        return;
    if (std::fseek(file_, offset, SEEK_SET) != 0)
        failure_ = errno != 0 ? errno : EIO;
}

Result<void> AtomicFile::commit()
{
    if (file_ == nullptr)
        return file_error(path_, "it is written already");
    // A full disk may be reported only here.
    if (std::fflush(file_) != 0 && failure_ == 0)
        failure_ = errno;
    if (std::fclose(std::exchange(file_, nullptr)) != 0 && failure_ == 0)
        failure_ = errno;
    if (failure_ != 0)
    {
        discard();
        return file_error(path_, std::strerror(failure_));
    }
    if (temporary_.path().empty())
        return {};
    Result<void> completed = temporary_.complete(target_);
    discard();
    return completed;
}

} // namespace voile::engine
