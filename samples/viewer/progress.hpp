// How far a long run is: a bar that is redrawn on a terminal, and elsewhere a plain line every ten seconds.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>

namespace viewer
{

struct ProgressSettings
{
    std::ostream* stream = nullptr; // null: standard error
    bool terminal = false;          // what the stream leads to
    std::function<double()> clock;  // seconds from any start; empty: a steady clock
};

// Standard error, and whether that is a terminal.
ProgressSettings default_progress();

class Progress
{
public:
    explicit Progress(uint32_t frames, ProgressSettings settings = default_progress());
    ~Progress(); // ends the bar's line, so that an error message starts on one of its own
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // `done` frames of all are done.
    void update(uint32_t done);
    // The last line: how many frames in what time. Call it once, when all went well.
    void finish();

private:
    void draw_bar(uint32_t done, double seconds);
    void write_line(uint32_t done, double seconds);

    uint32_t frames_;
    ProgressSettings settings_;
    double start_ = 0;
    double drawn_ = 0; // when the bar or a line was written last
    uint32_t done_ = 0;
    size_t bar_length_ = 0; // characters of the line on the terminal, 0: none
};

// "0:07", "12:30", "1:02:03".
std::string duration_text(double seconds);

} // namespace viewer
