// A temporary folder for a test with files.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

// Created empty. Removed with its contents when the test ends.
class TestFolder
{
public:
    TestFolder()
        : path_(std::filesystem::temp_directory_path() /
                ("voile_test_" + std::to_string(getpid()) + "_" + std::to_string(count_++)))
    {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TestFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

    std::filesystem::path write(const std::string& name, std::string_view bytes) const
    {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::string read(const std::string& name) const
    {
        std::ifstream file(path_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    // The number of files and folders in it, including hidden ones.
    [[nodiscard]] size_t entries() const
    {
        return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
    }
    [[nodiscard]] bool is_empty() const { return std::filesystem::is_empty(path_); }

private:
    static inline int count_ = 0;
    std::filesystem::path path_;
};
