// Progress of the small samples: lines on standard error, which may be a pipe.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>

namespace samples
{

class Progress
{
public:
    using Clock = std::chrono::steady_clock;

    // Create it before the device: the first line explains the silence until the first frame.
    explicit Progress(uint32_t frames) : frames_(frames)
    {
        std::fprintf(stderr, "preparing: compiling pipelines may take seconds\n");
    }

    // Prints at most one line per second, because the time per frame varies.
    void update(uint64_t done)
    {
        const Clock::time_point now = Clock::now();
        if (now - printed_ < std::chrono::seconds(1))
            return;
        printed_ = now;
        std::fprintf(stderr, "frame %u of %u\n", static_cast<unsigned>(done), frames_);
    }

private:
    uint32_t frames_;
    Clock::time_point printed_ = Clock::now();
};

} // namespace samples
