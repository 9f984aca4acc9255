// The progress of a long run, on a terminal and elsewhere.
#include "samples/viewer/progress.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>
#include <string>

TEST_CASE("without a terminal a plain line is written every ten seconds")
{
    std::ostringstream out;
    double now = 100;
    viewer::Progress progress(300, {&out, false, [&] { return now; }});
    for (uint32_t done = 1; done <= 300; ++done)
    {
        now += 0.125;
        progress.update(done);
    }
    progress.finish();
    CHECK(out.str() == "frame 80 of 300 (26 %), 0:10 elapsed\nframe 160 of 300 (53 %), 0:20 elapsed\n"
                       "frame 240 of 300 (80 %), 0:30 elapsed\n300 frames in 0:38 (8.0 frames/s)\n");
}

TEST_CASE("a bar is redrawn in place, at most ten times per second, and covers the old one")
{
    std::ostringstream out;
    double now = 0;
    {
        viewer::Progress progress(1000, {&out, true, [&] { return now; }});
        for (uint32_t done = 1; done <= 500; ++done)
        {
            now += 0.01;
            progress.update(done);
        }
        const std::string text = out.str();
        const auto bars = std::count(text.begin(), text.end(), '\r');
        CHECK(bars >= 40);
        CHECK(bars <= 51);
        CHECK(text.find('\n') == std::string::npos);
        progress.update(1000);
        CHECK(out.str().find("] 100 %, 1000/1000") != std::string::npos);
    }
    CHECK(out.str().ends_with("\n")); // an error message would start on a line of its own
}

TEST_CASE("a slow run is not silent")
{
    std::ostringstream out;
    double now = 0;
    {
        viewer::Progress bar(100000, {&out, true, [&] { return now; }});
        CHECK(out.str().find("] 0 %, 0/100000") != std::string::npos); // before the first frame
    }
    out.str("");
    viewer::Progress lines(100000, {&out, false, [&] { return now; }});
    for (uint32_t done = 1; done <= 5; ++done)
    {
        now += 8;
        lines.update(done);
    }
    CHECK(out.str() == "frame 2 of 100000 (0 %), 0:16 elapsed\nframe 4 of 100000 (0 %), 0:32 elapsed\n");
}

TEST_CASE("a run without frames ends as well")
{
    std::ostringstream out;
    viewer::Progress progress(0, {&out, false, [] { return 0.0; }});
    progress.update(0);
    progress.finish();
    CHECK(out.str().ends_with("0 frames in 0:00\n"));
}

TEST_CASE("durations are printed as h:mm:ss")
{
    CHECK(viewer::duration_text(7) == "0:07");
    CHECK(viewer::duration_text(59.6) == "1:00");
    CHECK(viewer::duration_text(750) == "12:30");
    CHECK(viewer::duration_text(3723) == "1:02:03");
    CHECK(viewer::duration_text(-1) == "0:00");
    CHECK(viewer::duration_text(1e30) == "99:59:59");
}
