// A run of a sample: what it prints, and when.
#pragma once

#include "support/test_folder.hpp"
#include "support/test_paths.hpp"

#include <doctest/doctest.h>

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

struct SampleRun
{
    struct Line
    {
        std::string text; // without its end
        double seconds;   // since the start
    };

    std::string output;       // standard output
    std::vector<Line> errors; // standard error
    int status = -1;          // the exit status; as in a shell, 128 and the signal that ended it
    double seconds = 0;
};

// Runs a sample in the folder. `environment`: assignments for its shell command.
inline SampleRun run_sample(const TestFolder& folder, const std::string& name, const std::string& arguments,
                            const std::string& environment = "")
{
    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&]
    { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
    const std::string command = "cd '" + folder.path().string() + "' && " + environment + " '" +
                                tests::program(name.c_str()).string() + "' " + arguments + " 2>&1 >output.txt";
    SampleRun run;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::array<char, 1024> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr)
    {
        std::string text = line.data();
        if (text.ends_with('\n'))
            text.pop_back();
        run.errors.push_back({text, elapsed()});
    }
    const int status = ::pclose(pipe);
    run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    run.seconds = elapsed();
    run.output = folder.read("output.txt");
    return run;
}

// Checks that the run succeeded and reported its progress by time.
inline void check_progress(const SampleRun& run)
{
    CAPTURE(run.output);
    std::string errors;
    for (const SampleRun::Line& line : run.errors)
        errors += line.text + '\n';
    CAPTURE(errors);
    REQUIRE(run.status == 0);
    REQUIRE(!run.errors.empty());
    CHECK(run.errors[0].text.starts_with("preparing"));
    std::vector<double> times;
    std::vector<unsigned> frames;
    for (const SampleRun::Line& line : run.errors)
        if (unsigned frame = 0; std::sscanf(line.text.c_str(), "frame %u of", &frame) == 1)
        {
            times.push_back(line.seconds);
            frames.push_back(frame);
        }
    CHECK(static_cast<double>(times.size()) <= run.seconds);
    // A fast device may end within the first second.
    if (run.seconds < 5)
        return;
    REQUIRE(!times.empty());
    // One line per frame, or at least one per three seconds.
    CHECK(times.size() >
          std::min(frames.back() - frames.front(), static_cast<unsigned>((times.back() - times.front()) / 3)));
}
