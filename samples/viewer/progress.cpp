#include "samples/viewer/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace viewer
{
namespace
{

constexpr double k_redraw_seconds = 0.1;
constexpr double k_line_seconds = 10;
constexpr uint32_t k_bar_cells = 30;

double steady_seconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

uint32_t parts_done(uint32_t done, uint32_t frames, uint32_t parts)
{
    if (frames == 0)
        return parts;
    return static_cast<uint32_t>(static_cast<uint64_t>(done) * parts / frames);
}

std::string rate_text(uint32_t done, double seconds)
{
    std::array<char, 48> text{};
    if (seconds > 0)
        (void)std::snprintf(text.data(), text.size(), "%.1f frames/s", static_cast<double>(done) / seconds);
    return text.data();
}

} // namespace

ProgressSettings default_progress()
{
    return {&std::cerr, ::isatty(STDERR_FILENO) == 1, {}};
}

std::string duration_text(double seconds)
{
    constexpr double k_longest = 359'999; // 99:59:59
    const auto whole = static_cast<unsigned>(std::lround(std::clamp(seconds, 0.0, k_longest)));
    std::array<char, 32> text{};
    if (whole >= 3600)
        (void)std::snprintf(text.data(), text.size(), "%u:%02u:%02u", whole / 3600, whole / 60 % 60, whole % 60);
    else
        (void)std::snprintf(text.data(), text.size(), "%u:%02u", whole / 60, whole % 60);
    return text.data();
}

Progress::Progress(uint32_t frames, ProgressSettings settings) : frames_(frames), settings_(std::move(settings))
{
    if (settings_.stream == nullptr)
        settings_.stream = &std::cerr;
    if (!settings_.clock)
        settings_.clock = steady_seconds;
    start_ = drawn_ = settings_.clock();
    if (settings_.terminal)
        draw_bar(0, 0); // the first frame may take minutes
}

Progress::~Progress()
{
    if (bar_length_ > 0)
        *settings_.stream << '\n' << std::flush;
}

void Progress::update(uint32_t done)
{
    done_ = std::min(done, frames_);
    const double now = settings_.clock();
    if (settings_.terminal)
    {
        if (now - drawn_ < k_redraw_seconds && done_ < frames_)
            return;
        drawn_ = now;
        draw_bar(done_, now - start_);
    }
    else if (now - drawn_ >= k_line_seconds)
    {
        drawn_ = now;
        write_line(done_, now - start_);
    }
}

void Progress::finish()
{
    const double seconds = settings_.clock() - start_;
    std::string line = std::to_string(done_) + (done_ == 1 ? " frame in " : " frames in ") + duration_text(seconds);
    if (done_ > 0 && seconds > 0)
        line += " (" + rate_text(done_, seconds) + ")";
    // What the bar had beyond this line is overwritten by spaces.
    const size_t rest = bar_length_ > line.size() ? bar_length_ - line.size() : 0;
    *settings_.stream << (bar_length_ > 0 ? "\r" : "") << line << std::string(rest, ' ') << '\n' << std::flush;
    bar_length_ = 0;
}

void Progress::draw_bar(uint32_t done, double seconds)
{
    const uint32_t cells = parts_done(done, frames_, k_bar_cells);
    std::string line = '[' + std::string(cells, '#') + std::string(k_bar_cells - cells, '.') + "] " +
                       std::to_string(parts_done(done, frames_, 100)) + " %, " + std::to_string(done) + "/" +
                       std::to_string(frames_);
    if (done > 0 && seconds > 0)
    {
        const double left = seconds * static_cast<double>(frames_ - done) / static_cast<double>(done);
        line += ", " + rate_text(done, seconds) + ", " + duration_text(left) + " left";
    }
    const size_t length = line.size();
    if (length < bar_length_)
        line.append(bar_length_ - length, ' ');
    bar_length_ = length;
    *settings_.stream << '\r' << line << std::flush;
}

void Progress::write_line(uint32_t done, double seconds)
{
    *settings_.stream << "frame " << done << " of " << frames_ << " (" << parts_done(done, frames_, 100) << " %), "
                      << duration_text(seconds) << " elapsed\n"
                      << std::flush;
}

} // namespace viewer
