// The viewer as a program of its own: what it says and how it ends.
#pragma once

#include "support/test_paths.hpp"

#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace tests
{

inline std::string text_of(const std::filesystem::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

struct Run
{
    int exit_code = -1;
    std::string output;
    std::string errors;
};

// `environment`: assignments before the command, as a shell takes them.
inline Run run_viewer(const std::string& arguments, const std::string& environment = "")
{
    const std::string base =
        (std::filesystem::temp_directory_path() / ("voile_run_" + std::to_string(getpid()))).string();
    const std::string command = "env -u DISPLAY -u WAYLAND_DISPLAY " + environment + " '" + program("viewer").string() +
                                "' " + arguments + " >" + base + ".out 2>" + base + ".err";
    const int status = std::system(command.c_str());
    Run run{WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(base + ".out"), text_of(base + ".err")};
    std::filesystem::remove(base + ".out");
    std::filesystem::remove(base + ".err");
    return run;
}

// Exit code 1 and a single line that holds every one of `parts`.
inline void check_refused(const Run& run, const std::vector<std::string>& parts)
{
    CAPTURE(run.errors);
    CHECK(run.exit_code == 1);
    CHECK(run.errors.find("viewer: ") == 0);
    CHECK(std::count(run.errors.begin(), run.errors.end(), '\n') == 1);
    for (const std::string& part : parts)
    {
        CAPTURE(part);
        CHECK(run.errors.find(part) != std::string::npos);
    }
}

} // namespace tests
